#include "casedef/execution.h"

#include "core/finite_number.h"
#include "core/text.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace fppg
{
namespace
{

void evaluate_all(Element& e, const AttributeReader& read)
{
    for (Element::Attribute& a : e.attributes) a.value = read.evaluated(e, a.name);
    for (Element& child : e.children)
        if (child.kind == Element::Kind::Tag) evaluate_all(child, read);
}

void complete_domain(Element& domain, const AttributeReader& read)
{
    for (const bool is_min : {true, false})
        if (Element* limit = domain.find_child(is_min ? "posmin" : "posmax"))
            for (Element::Attribute& a : limit->attributes)
                if (a.name == "x" || a.name == "y" || a.name == "z")
                    a.value = domain_limit(read, *limit, a.value, is_min);
}

void evaluate_parameters(Element& parameters, const AttributeReader& read)
{
    bool has_domain = false;
    for (Element& e : parameters.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.name == "parameter")
        {
            // "#Name" is a parameter that is switched off.
            const std::string key = read.text(e, "key");
            const std::string value = read.evaluated(e, "value");
            e.set_attribute("key", key);
            e.set_attribute("value", value);
        }
        else if (e.name == "simulationdomain" && !has_domain)
        {
            complete_domain(e, read);
            has_domain = true;
        }
        else
            read.fail(e, has_domain && e.name == "simulationdomain"
                             ? "there are two of it in <parameters>, expected one"
                             : "is not known in <parameters>, expected parameter or "
                               "simulationdomain");
    }
}

Element* first_of(std::vector<Element>& elements, std::string_view name)
{
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const Element& e)
                                    { return e.kind == Element::Kind::Tag && e.name == name; });
    return found == elements.end() ? nullptr : &*found;
}

} // namespace

std::vector<Element> read_execution(const Element& root, const AttributeReader& read)
{
    const Element* execution = root.find_child("execution");
    if (execution == nullptr || execution->find_child("parameters") == nullptr)
        read.fail(root, "the element <execution><parameters> is missing in it");
    static const std::set<std::string> own{"particles", "constants", "vres",
                                           "uservars",  "motion",    "vtkout"};
    std::vector<Element> out;
    int blocks = 0;
    for (const Element& e : execution->children)
    {
        const bool is_tag = e.kind == Element::Kind::Tag;
        if (is_tag && e.name == "parameters" && ++blocks > 2)
            read.fail(e, "there are more than two of it in <execution>, expected one");
        if (!is_tag || !own.contains(e.name)) out.push_back(e);
    }
    return out;
}

void evaluate_execution(std::vector<Element>& execution, const AttributeReader& read)
{
    evaluate_parameters(*first_of(execution, "parameters"), read);
    if (Element* special = first_of(execution, "special")) evaluate_all(*special, read);
}

std::optional<std::string> parameter_value(const std::vector<Element>& execution,
                                           std::string_view key)
{
    std::optional<std::string> out;
    for (const Element& parameters : execution)
    {
        if (parameters.kind != Element::Kind::Tag || parameters.name != "parameters") continue;
        for (const Element& e : parameters.children)
        {
            if (e.kind != Element::Kind::Tag || e.name != "parameter") continue;
            const std::string* own = e.find_attribute("key");
            const std::string* value = e.find_attribute("value");
            const std::string* active = e.find_attribute("active");
            const bool is_off = active != nullptr && (*active == "false" || *active == "0");
            if (own != nullptr && value != nullptr && *own == key && !is_off) out = *value;
        }
    }
    return out;
}

void read_periodic_axes(const std::vector<Element>& execution, const std::string& file,
                        std::array<bool, 3>& is_periodic, std::array<Vec3, 3>& shift)
{
    is_periodic = {};
    shift = {};
    for (const std::size_t axis : {0U, 1U, 2U})
        for (const std::size_t to : {0U, 1U, 2U})
        {
            const std::string key = fmt::format("{}PeriodicInc{}", "XYZ"[axis], "XYZ"[to]);
            const std::optional<std::string> text =
                axis == to ? std::nullopt : parameter_value(execution, key);
            if (!text) continue;
            const std::optional<double> value = finite_number(*text);
            if (!value)
                throw CaseError(fmt::format("{}: parameter {}: \"{}\" is invalid, expected metres",
                                            file, key, *text));
            is_periodic[axis] = true;
            // The solver's increment leads from the end of the period back to its begin.
            shift[axis][static_cast<int>(to)] = -*value;
        }
    for (const std::size_t open : {2U, 1U, 0U})
    {
        static constexpr const char* keys[] = {"YZPeriodic", "XZPeriodic", "XYPeriodic"};
        if (!parameter_value(execution, keys[open])) continue;
        is_periodic = {true, true, true};
        is_periodic[open] = false;
        shift = {};
    }
}

std::string domain_limit(const AttributeReader& read, const Element& e, const std::string& text,
                         bool is_min)
{
    std::string bare;
    for (const char c : text)
        if (c != ' ') bare += lower_case(c);
    std::string_view rest = bare;
    const bool is_default = rest.starts_with("default");
    if (is_default) rest.remove_prefix(7);
    if (rest.empty()) return bare;
    const char sign = is_min ? '-' : '+';
    const bool has_sign = rest.front() == sign;
    if (is_default ? has_sign : rest.front() == '+') rest.remove_prefix(1);
    const bool is_percent = is_default && rest.ends_with('%');
    if (is_percent) rest.remove_suffix(1);
    const std::optional<double> value = finite_number(rest);
    if ((is_default && !has_sign) || !value)
        read.fail(e, fmt::format("\"{}\" is invalid, expected a number, default, default {} "
                                 "NUMBER or default {} NUMBER%",
                                 text, sign, sign));
    if (!is_default) return bare;
    return fmt::format("default {} {}{}", sign, *value, is_percent ? "%" : "");
}

} // namespace fppg
