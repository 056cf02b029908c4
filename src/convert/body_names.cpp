#include "convert/body_names.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace fppg
{

namespace
{

/// mkbound or mkfluid, and whether it is of fluid.
using MkKey = std::pair<bool, int>;

struct MkNames
{
    std::map<MkKey, std::string> of_mk;
    std::map<MkKey, std::set<std::string>> of_draws;
};

/// Walks the commands of a list and keeps the names that it meets.
class NameWalk
{
public:
    NameWalk(const Element& commands, MkNames& names) : commands_(commands), names_(names) {}

    void walk(const Element& list, int depth = 0)
    {
        for (const Element& e : list.children)
        {
            if (e.kind != Element::Kind::Tag) continue;
            if (e.name == "setmkbound" || e.name == "setmkfluid")
                set_mk(e);
            else if (e.name == "setmkvoid" || e.name.starts_with("setmknext"))
                mk_.reset();
            else if (e.name == "runlist")
                run_list(e, depth);
            else if (e.name.starts_with("draw") && mk_)
                keep_draw(e);
            walk(e, depth);
        }
    }

private:
    const Element& commands_;
    MkNames& names_;
    std::optional<MkKey> mk_;

    void set_mk(const Element& e)
    {
        mk_.reset();
        const std::string* text = e.find_attribute("mk");
        int mk = 0;
        if (text == nullptr) return;
        const char* end = text->data() + text->size();
        if (std::from_chars(text->data(), end, mk).ptr != end) return;
        mk_ = MkKey(e.name == "setmkfluid", mk);
        const std::string* name = e.find_attribute("name");
        if (name != nullptr && !name->empty()) names_.of_mk.emplace(*mk_, *name);
    }

    void keep_draw(const Element& e)
    {
        for (const char* attribute : {"fppg:name", "objname"})
            if (const std::string* name = e.find_attribute(attribute); name && !name->empty())
            {
                names_.of_draws[*mk_].insert(*name);
                return;
            }
    }

    void run_list(const Element& e, int depth)
    {
        constexpr int deepest = 8;
        const std::string* wanted = e.find_attribute("name");
        if (wanted == nullptr || depth == deepest) return;
        for (const Element& list : commands_.children)
            if (const std::string* name = list.find_attribute("name");
                list.name == "list" && name && *name == *wanted)
                walk(list, depth + 1);
    }
};

/// Only letters, digits and '_', first a letter.
std::string plain_name(const std::string& name)
{
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    std::string out;
    for (const char c : name) out += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
    if (!is_letter(out[0])) out.insert(0, "body_");
    return out;
}

} // namespace

void name_bodies(const Element& casedef, const std::vector<std::uint16_t>& mk_types,
                 std::vector<FeedBody>& bodies)
{
    MkNames names;
    const Element* geometry = casedef.find_child("geometry");
    const Element* commands = geometry != nullptr ? geometry->find_child("commands") : nullptr;
    const Element* main = commands != nullptr ? commands->find_child("mainlist") : nullptr;
    if (main != nullptr) NameWalk(*commands, names).walk(*main);
    std::set<std::string> taken;
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        FeedBody& body = bodies[i];
        const bool is_fluid = body.type == ParticleType::Fluid;
        const MkKey key(is_fluid, mk_types[i]);
        const auto draws = names.of_draws.find(key);
        if (const auto named = names.of_mk.find(key); named != names.of_mk.end())
            body.name = plain_name(named->second);
        else if (draws != names.of_draws.end() && draws->second.size() == 1)
            body.name = plain_name(*draws->second.begin());
        else
            body.name = fmt::format("{}{}", is_fluid ? "fluid" : "bound", mk_types[i]);
        if (!taken.insert(body.name).second) taken.insert(body.name += fmt::format("_{}", body.mk));
    }
}

} // namespace fppg
