#include "compare/value_differences.h"

#include "core/finite_number.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

namespace fppg
{

namespace
{

/// The attribute that tells elements of one name apart.
std::string key_of(const Element& element)
{
    for (const char* name : {"mk", "mkbound", "mkfluid", "key", "name", "ref", "id", "objid"})
        // Ranges of ids say what an element holds, not which one it is.
        if (const std::string* value = element.find_attribute(name);
            value != nullptr && value->find('-') == std::string::npos)
            return fmt::format("[{}={}]", name, *value);
    return {};
}

class TreeWalk
{
public:
    TreeWalk(const CompareOptions& options, double dp, std::vector<ValueDifference>& out)
        : options_(options), dp_(dp), out_(out)
    {
    }

    void compare(const Element& a, const Element& b, const std::string& path)
    {
        compare_attributes(a, b, path);
        if (a.text != b.text) add(path, a.text, b.text, 0);
        // Elements of one name and key are compared in their order.
        std::map<std::string, std::vector<const Element*>> left;
        for (const Element& child : b.children)
            if (child.kind == Element::Kind::Tag)
                left[child.name + key_of(child)].push_back(&child);
        for (auto& [name, children] : left) std::reverse(children.begin(), children.end());
        std::map<std::string, int> seen;
        for (const Element& child : a.children)
        {
            if (child.kind != Element::Kind::Tag) continue;
            const std::string name = child.name + key_of(child);
            const std::string place = place_of(path, name, ++seen[name]);
            std::vector<const Element*>& partners = left[name];
            if (partners.empty())
                add_missing(place, true);
            else
            {
                compare(child, *partners.back(), place);
                partners.pop_back();
            }
        }
        for (auto& [name, children] : left)
            for (std::size_t i = 0; i < children.size(); ++i)
                add_missing(place_of(path, name, ++seen[name]), false);
    }

private:
    const CompareOptions& options_;
    double dp_;
    std::vector<ValueDifference>& out_;

    static std::string place_of(const std::string& path, const std::string& name, int number)
    {
        const std::string whole = path.empty() ? name : path + "/" + name;
        return number == 1 ? whole : fmt::format("{}({})", whole, number);
    }
    void add(const std::string& place, std::optional<std::string> a, std::optional<std::string> b,
             double tolerance)
    {
        ValueDifference difference{place, std::move(a), std::move(b), 1, false};
        if (difference.a && difference.b)
        {
            const std::optional<double> x = finite_number(*difference.a);
            const std::optional<double> y = finite_number(*difference.b);
            if (x && y)
            {
                const double apart = std::abs(*x - *y);
                const double larger = std::max(std::abs(*x), std::abs(*y));
                if (apart <= tolerance) return;
                difference.size = std::min(1.0, apart / larger);
            }
        }
        difference.is_constant = place.starts_with("execution/constants/");
        out_.push_back(std::move(difference));
    }
    void add_missing(const std::string& place, bool is_in_a)
    {
        ValueDifference difference{place, {}, {}, 1, place.starts_with("execution/constants/")};
        (is_in_a ? difference.a : difference.b) = "there";
        out_.push_back(std::move(difference));
    }

    /// Vectors and rows of tensors are measured by their largest entry, places by dp besides.
    double tolerance_of(const Element& a, const Element& b, const std::string& name) const
    {
        const bool is_of_vector =
            name == "x" || name == "y" || name == "z" || (name.size() == 3 && name[0] == 'v');
        double largest = 0;
        for (const Element* element : {&a, &b})
            for (const Element::Attribute& attribute : element->attributes)
                if (is_of_vector || attribute.name == name)
                    if (const std::optional<double> value = finite_number(attribute.value))
                        largest = std::max(largest, std::abs(*value));
        const bool is_place = is_of_vector && (a.name == "center" || a.name.starts_with("pos") ||
                                               a.name.starts_with("point"));
        return options_.constants * (largest + (is_place ? dp_ : 0));
    }
    void compare_attributes(const Element& a, const Element& b, const std::string& path)
    {
        const bool is_root = path.empty();
        const auto is_of_maker = [&](const std::string& name)
        { return is_root && (name == "app" || name == "date"); };
        for (const Element::Attribute& attribute : a.attributes)
        {
            if (is_of_maker(attribute.name)) continue;
            const std::string* other = b.find_attribute(attribute.name);
            if (other != nullptr && *other == attribute.value) continue;
            add(path + "@" + attribute.name, attribute.value,
                other ? std::optional(*other) : std::nullopt, tolerance_of(a, b, attribute.name));
        }
        for (const Element::Attribute& attribute : b.attributes)
            if (!is_of_maker(attribute.name) && a.find_attribute(attribute.name) == nullptr)
                add(path + "@" + attribute.name, {}, attribute.value, 0);
    }
};

template <typename T>
T as(std::string_view data, std::size_t i = 0)
{
    T value;
    std::memcpy(&value, data.data() + i * sizeof value, sizeof value);
    return value;
}

/// Numbers of a value; none for a text.
std::vector<double> numbers_of(const BinaryValue& value)
{
    const std::string_view d = value.data;
    switch (value.type)
    {
        case 2:
        case 7:
            return {double{as<std::int32_t>(d) * 1.0}};
        case 3:
            return {as<std::int8_t>(d) * 1.0};
        case 4:
            return {as<std::uint8_t>(d) * 1.0};
        case 5:
            return {as<std::int16_t>(d) * 1.0};
        case 6:
            return {as<std::uint16_t>(d) * 1.0};
        case 8:
            return {as<std::uint32_t>(d) * 1.0};
        case 9:
            return {static_cast<double>(as<std::int64_t>(d))};
        case 10:
            return {static_cast<double>(as<std::uint64_t>(d))};
        case 11:
            return {double{as<float>(d)}};
        case 12:
            return {as<double>(d)};
        case 22:
            return {as<float>(d, 0), as<float>(d, 1), as<float>(d, 2)};
        case 23:
            return {as<double>(d, 0), as<double>(d, 1), as<double>(d, 2)};
        case 20:
        case 21:
            return {as<std::int32_t>(d, 0) * 1.0, as<std::int32_t>(d, 1) * 1.0,
                    as<std::int32_t>(d, 2) * 1.0};
        default:
            return {};
    }
}

std::string text_of(const BinaryValue& value)
{
    if (value.type == 1) return std::string(value.data);
    std::string text;
    for (const double n : numbers_of(value))
        text += fmt::format("{}{}", text.empty() ? "" : " ", n);
    return text;
}

using NamedValues = std::map<std::string, const BinaryValue*>;

/// Whether a value of Case.bi4 is a constant of the case: not a count or a limit of the particles,
/// which tell what the particles tell.
bool is_constant(const std::string& name)
{
    return name.find('/') == std::string::npos && !name.starts_with("CaseN") &&
           !name.starts_with("CasePos");
}

void collect(const BinaryItem& item, const std::string& path, NamedValues& out)
{
    for (const BinaryValue& value : item.values) out[path + std::string(value.name)] = &value;
    for (const BinaryItem& child : item.items)
        collect(child, path + std::string(child.name) + "/", out);
}

void compare_values(const ParticleSource& a, const ParticleSource& b, const CompareOptions& options,
                    double dp, std::vector<ValueDifference>& out)
{
    NamedValues of_a;
    NamedValues of_b;
    for (const BinaryItem& item : a.bi4().items) collect(item, "", of_a);
    for (const BinaryItem& item : b.bi4().items) collect(item, "", of_b);
    for (const char* name : {"AppName", "Date", "RunCode", "CaseName"})
        for (NamedValues* values : {&of_a, &of_b}) values->erase(name);
    for (const auto& [name, value] : of_a)
    {
        ValueDifference difference{"Case.bi4 " + name, text_of(*value), {}, 1, is_constant(name)};
        const auto other = of_b.find(name);
        if (other != of_b.end())
        {
            difference.b = text_of(*other->second);
            const std::vector<double> x = numbers_of(*value);
            const std::vector<double> y = numbers_of(*other->second);
            if (difference.a == difference.b) continue;
            if (!x.empty() && x.size() == y.size())
            {
                double apart = 0;
                double largest = 0;
                for (std::size_t i = 0; i < x.size(); ++i)
                {
                    apart = std::max(apart, std::abs(x[i] - y[i]));
                    largest = std::max({largest, std::abs(x[i]), std::abs(y[i])});
                }
                const bool is_place = name.find("Pos") != std::string::npos;
                if (apart <= options.constants_bi4 * (largest + (is_place ? dp : 0))) continue;
                difference.size = std::min(1.0, apart / largest);
            }
        }
        out.push_back(std::move(difference));
    }
    for (const auto& [name, value] : of_b)
        if (!of_a.contains(name))
            out.push_back({"Case.bi4 " + name, {}, text_of(*value), 1, is_constant(name)});
}

} // namespace

std::vector<ValueDifference> value_differences(const ParticleSource& a, const ParticleSource& b,
                                               const CompareOptions& options, double dp,
                                               std::vector<std::string>& notes)
{
    std::vector<ValueDifference> out;
    if (a.is_bi4() && b.is_bi4())
        compare_values(a, b, options, dp, out);
    else
        notes.push_back(
            "The values of Case.bi4 are not compared: not both results are read from one.");
    if (a.xml() && b.xml())
    {
        if (a.xml()->name != b.xml()->name)
            out.push_back({"root", a.xml()->name, b.xml()->name, 1});
        TreeWalk(options, dp, out).compare(*a.xml(), *b.xml(), "");
    }
    else
        notes.push_back(fmt::format("Case.xml is not compared: {} has none.", !a.xml() && !b.xml()
                                                                                  ? "neither result"
                                                                              : a.xml() ? "B"
                                                                                        : "A"));
    std::stable_sort(out.begin(), out.end(),
                     [](const ValueDifference& x, const ValueDifference& y)
                     { return x.is_constant > y.is_constant; });
    return out;
}

std::string maker_of(const ParticleSource& source, const char* attribute)
{
    if (source.xml())
        if (const std::string* text = source.xml()->find_attribute(attribute)) return *text;
    return {};
}

} // namespace fppg
