#include "fppg/compare.h"

#include "compare/report_words.h"
#include "core/json.h"

namespace fppg
{

namespace
{

Json as_json(const Vec3& p)
{
    return {p.x, p.y, p.z};
}

Json as_json(const Statistics& statistics, const HistogramRange& range)
{
    Json json;
    json["count"] = statistics.count;
    if (statistics.count == 0) return json;
    json["mean"] = statistics.mean;
    json["deviation"] = statistics.deviation;
    json["least"] = statistics.least;
    json["largest"] = statistics.largest;
    json["histogram"] = {
        {"begin", range.begin}, {"end", range.end}, {"counts", statistics.histogram}};
    return json;
}

Json as_json(const ArrayDifference& array)
{
    return {{"differing", array.differing}, {"largest", array.largest}};
}

Json as_json(const MkComparison& of, bool has_geometry)
{
    Json json;
    json["mk"] = of.mk;
    json["type"] = {particle_type_name(of.type[0]), particle_type_name(of.type[1])};
    json["count"] = of.count;
    json["same_place"] = of.same;
    json["moved"] = of.moved;
    json["missing"] = of.missing;
    json["extra"] = of.extra;
    json["mk_changed"] = of.mk_changed;
    json["mk_gained"] = of.mk_gained;
    json["id_changed"] = of.id_changed;
    json["moved_dp"] = as_json(of.moved_dp, moved_range);
    json["alone"] = of.alone;
    for (const std::size_t f : {0U, 1U})
    {
        json["spacing_dp"].push_back(as_json(of.spacing_dp[f], spacing_range));
        json["shepard"].push_back(as_json(of.shepard[f], shepard_range));
        if (has_geometry) json["distance_dp"].push_back(as_json(of.distance_dp[f], distance_range));
    }
    json["density"] = as_json(of.density);
    json["velocity"] = as_json(of.velocity);
    json["normal_dp"] = as_json(of.normal);
    return json;
}

Json as_json(const ChangedParticle& p)
{
    Json json;
    json["kind"] = change_name(p.kind);
    json["size"] = p.size;
    static constexpr const char* names[] = {"a", "b"};
    for (const std::size_t f : {0U, 1U})
    {
        if (p.kind == (f == 0 ? ChangeKind::Extra : ChangeKind::Missing)) continue;
        json[names[f]] = {{"index", p.index[f]},
                          {"id", p.id[f]},
                          {"mk", p.mk[f]},
                          {"at", as_json(p.position[f])}};
    }
    return json;
}

} // namespace

std::string to_json(const Comparison& comparison)
{
    Json json;
    json["is_equal"] = comparison.is_equal();
    json["dp"] = comparison.dp;
    json["same_place_m"] = comparison.same_place_m;
    json["is_2d"] = comparison.is_2d;
    json["files"] = Json::array();
    for (const ComparedFile& file : comparison.files)
    {
        Json of;
        of["path"] = file.path;
        of["app"] = file.app_name;
        of["date"] = file.date;
        of["dp"] = file.dp;
        of["np"] = file.np;
        if (!file.bounds.is_empty())
            of["bounds"] = {{"min", as_json(file.bounds.min)}, {"max", as_json(file.bounds.max)}};
        json["files"].push_back(of);
    }
    json["geometry"] = comparison.options.geometry;
    json["findings"] = Json::array();
    for (const Finding& finding : comparison.findings)
        json["findings"].push_back(
            {{"size", finding.size}, {"category", finding.category}, {"text", finding.text}});
    json["mks"] = Json::array();
    for (const MkComparison& of : comparison.mks)
        json["mks"].push_back(as_json(of, comparison.has_geometry));
    json["examples"] = Json::array();
    for (const ChangedParticle& p : comparison.examples) json["examples"].push_back(as_json(p));
    json["values"] = Json::array();
    for (const ValueDifference& value : comparison.values)
    {
        Json of;
        of["place"] = value.place;
        of["a"] = value.a ? Json(*value.a) : Json();
        of["b"] = value.b ? Json(*value.b) : Json();
        of["size"] = value.size;
        json["values"].push_back(of);
    }
    json["notes"] = comparison.notes;
    // Names of files need not be UTF-8.
    return json.text(2) + "\n";
}

} // namespace fppg
