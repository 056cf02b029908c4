#include "report/scene.h"

#include "core/json.h"
#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

std::string text_of(const Json& json)
{
    // "</script>" inside a name would end the element.
    std::string text = json.text();
    for (std::size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at))
        text.replace(at, 2, "<\\/");
    return text;
}

} // namespace

namespace
{

/// Rows of rotations and moves, to a micrometre a metre.
Json frames_json(const std::vector<Transform>& frames)
{
    Json out = Json::array();
    for (const Transform& t : frames)
    {
        Json one = Json::array();
        for (int i = 0; i < 3; ++i)
        {
            const Vec3& row = t.linear[static_cast<std::size_t>(i)];
            for (const double v : {row.x, row.y, row.z, t.offset[i]})
                one.push_back(std::round(v * 1e6) / 1e6);
        }
        out.push_back(one);
    }
    return out;
}

/// Six digits of what is as large as the scene.
Json place_json(const Vec3& p, double size)
{
    const double scale = size > 0 ? std::pow(10, 6 - std::floor(std::log10(size))) : 1;
    Json out = Json::array();
    for (int axis = 0; axis < 3; ++axis) out.push_back(std::round(p[axis] * scale) / scale);
    return out;
}

Json marks_json(const SceneSet& set, double size)
{
    Json marks = Json::array();
    for (const SceneMark& mark : set.marks)
        marks.push_back(
            {{"frame", mark.frame}, {"at", place_json(mark.place, size)}, {"text", mark.text}});
    Json start = Json::array();
    for (const Vec3& p : set.start_marks) start.push_back(place_json(p, size));
    return {{"label", set.mark_label}, {"frames", set.frames}, {"places", marks}, {"start", start}};
}

} // namespace

std::string to_json(const SceneSet& set)
{
    Box3 box;
    for (const ScenePart& part : set.parts)
        for (const Vec3& p : part.positions) box.add(p);
    if (box.is_empty()) box.add({});
    std::string bytes;
    Json parts = Json::array();
    for (const ScenePart& part : set.parts)
    {
        Json one{{"label", part.label}, {"colour", part.colour}, {"count", part.positions.size()}};
        if (!part.frames.empty()) one["frames"] = frames_json(part.frames);
        parts.push_back(one);
        for (const Vec3& p : part.positions)
            for (int axis = 0; axis < 3; ++axis)
            {
                const double extent = box.max[axis] - box.min[axis];
                const double share = extent > 0 ? (p[axis] - box.min[axis]) / extent : 0;
                const auto value =
                    static_cast<unsigned>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
                bytes += static_cast<char>(value & 0xFFU);
                bytes += static_cast<char>(value >> 8U);
            }
    }
    const double size = norm(box.max - box.min);
    return text_of({{"name", set.name},
                    {"dp", set.dp},
                    {"box", {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z}},
                    {"end", set.end},
                    {"parts", parts},
                    {"marks", set.mark_label.empty() ? Json() : marks_json(set, size)},
                    {"positions", base64(bytes)}});
}

std::string scene_html(const std::vector<std::string>& sets, const std::vector<SceneView>& views)
{
    if (views.empty()) return "<p>There are no particles for a 3-D view.</p>\n";
    if (viewer_script().empty())
        return "<p>This page has no 3-D view: the program was built where neither npm nor the "
               "packages esbuild and libjs-three were at hand.</p>\n";
    std::string html =
        "<div id=\"fppg-view\"></div>\n<script type=\"application/json\" id=\"fppg-scene\">"
        "{\"sets\":[";
    for (std::size_t i = 0; i < sets.size(); ++i) (html += i > 0 ? ",\n" : "") += sets[i];
    Json list = Json::array();
    for (const SceneView& view : views)
        list.push_back({{"title", view.title}, {"sets", view.sets}, {"names", view.names}});
    return html + "],\n\"views\":" + text_of(list) + "}</script>\n<script>" +
           std::string(viewer_script()) + "</script>\n";
}

} // namespace fppg
