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
        parts.push_back(
            {{"label", part.label}, {"colour", part.colour}, {"count", part.positions.size()}});
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
    return text_of({{"name", set.name},
                    {"dp", set.dp},
                    {"box", {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z}},
                    {"parts", parts},
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
