#include "report/result_look.h"

#include "core/json.h"
#include "report/html.h"
#include "report/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace fppg
{

namespace
{

bool shows_two(const std::vector<ResultLook>& looks)
{
    return looks.size() == 2 && !looks[0].set.empty() && !looks[1].set.empty();
}

} // namespace

std::string to_json(const ResultLook& look)
{
    const Json json = {{"set", look.set}, {"details", look.details}};
    return json.text() + "\n";
}

ResultLook read_look(const std::string& json)
{
    try
    {
        const Json read = Json::parse(json);
        ResultLook look;
        read.at("set").get_to(look.set);
        read.at("details").get_to(look.details);
        return look;
    }
    catch (const JsonError&)
    {
        return {};
    }
}

std::string pictures_html(const std::vector<ResultLook>& looks)
{
    std::string html = "<div class=\"runs\">\n";
    std::size_t view = shows_two(looks) ? 1 : 0;
    for (const ResultLook& look : looks)
    {
        std::string picture = look.picture.empty() ? "" : picture_html(look.picture, look.name);
        if (!picture.empty() && !look.set.empty())
            picture =
                fmt::format("<button type=\"button\" data-view=\"{}\">{}</button>", view, picture);
        if (!look.set.empty()) ++view;
        if (picture.empty()) continue;
        html += fmt::format("<figure>{}<figcaption>{}{}</figcaption></figure>\n", picture,
                            escaped_html(look.name), look.note);
    }
    return html + "</div>\n";
}

std::string views_html(const std::vector<ResultLook>& looks)
{
    std::vector<std::string> sets;
    std::vector<SceneView> views;
    if (shows_two(looks))
        views.push_back(
            {looks[0].name + " and " + looks[1].name, {0, 1}, {looks[0].name, looks[1].name}});
    for (const ResultLook& look : looks)
    {
        if (look.set.empty()) continue;
        views.push_back({look.name, {sets.size()}, {look.name}});
        sets.push_back(look.set);
    }
    return scene_html(sets, views);
}

std::string details_html(const std::vector<ResultLook>& looks)
{
    std::string html;
    for (const ResultLook& look : looks)
        if (!look.details.empty())
            html += fmt::format("<details{}><summary>{}</summary>\n{}</details>\n",
                                looks.size() == 1 ? " open" : "", escaped_html(look.name),
                                look.details);
    return html;
}

} // namespace fppg
