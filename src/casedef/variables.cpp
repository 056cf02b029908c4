#include "casedef/variables.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace fppg
{

namespace
{

void check_name(std::string_view name)
{
    constexpr std::array reserved{"all", "none", "true", "false", "e"};
    const bool is_name = !name.empty() && std::all_of(name.begin(), name.end(), is_name_character);
    if (!is_name)
        throw ExpressionError(0, fmt::format("'{}' is no name of a variable; expected letters, "
                                             "digits and _",
                                             name));
    if (std::find(reserved.begin(), reserved.end(), lower_case(name)) != reserved.end())
        throw ExpressionError(
            0, fmt::format("the name '{}' cannot be used for a variable; all, none, true, false "
                           "and e are reserved",
                           name));
}

bool is_pattern(std::string_view text)
{
    return text.find_first_of("*?") != std::string_view::npos;
}

bool matches(std::string_view pattern, std::string_view name)
{
    std::size_t p = 0;
    std::size_t n = 0;
    std::size_t star = std::string_view::npos;
    std::size_t star_end = 0; // the last `*` stands for name[.., star_end)
    while (n < name.size())
    {
        if (p < pattern.size() && pattern[p] == '*')
        {
            star = p++;
            star_end = n;
        }
        else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n]))
        {
            ++p;
            ++n;
        }
        else if (star != std::string_view::npos)
        {
            p = star + 1;
            n = ++star_end;
        }
        else
            return false;
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// The parts between commas, without blanks; empty ones are left out.
std::vector<std::string> split_list(std::string_view text)
{
    std::vector<std::string> parts(1);
    for (const char c : text)
    {
        if (c == ',')
            parts.emplace_back();
        else if (c != ' ')
            parts.back().push_back(c);
    }
    std::erase(parts, std::string());
    return parts;
}

double evaluate_attribute(std::string_view text, const Variables& variables)
{
    if (text.starts_with('#')) text.remove_prefix(1);
    return evaluate_expression(text, variables);
}

std::string value_text(const VariableValue& value)
{
    const double* number = std::get_if<double>(&value);
    return number ? format_number(*number) : std::get<std::string>(value);
}

bool is_text(const Variable& variable)
{
    return std::holds_alternative<std::string>(variable.value);
}

/// A text that begins with '$' is the one behind it.
std::string_view without_sign(std::string_view text)
{
    return text.starts_with('$') ? text.substr(1) : text;
}

} // namespace

const Variable* Variables::find_entry(std::string_view name) const
{
    const auto entry = std::find_if(variables_.begin(), variables_.end(),
                                    [&](const Variable& v) { return v.name == name; });
    return entry == variables_.end() ? nullptr : &*entry;
}

Variable* Variables::find_entry(std::string_view name)
{
    return const_cast<Variable*>(std::as_const(*this).find_entry(name));
}

std::optional<VariableValue> Variables::find(std::string_view name) const
{
    const Variable* entry = find_entry(name);
    return entry ? std::optional(entry->value) : std::nullopt;
}

bool Variables::is_variable_attribute(std::string_view attribute)
{
    return attribute != "if" && attribute != "_rem" && attribute != "_print";
}

void Variables::predefine(const std::string& name, VariableValue value, bool is_exported)
{
    if (Variable* old = find_entry(name); old != nullptr && old->value.index() == value.index())
        *old = {name, std::move(value), true, is_exported};
    else
        define(name, std::move(value), true);
    find_entry(name)->is_exported = is_exported;
}

void Variables::define(const std::string& name, VariableValue value, bool is_constant)
{
    check_name(name);
    const Variable* old = find_entry(name);
    if (!old)
    {
        variables_.push_back({name, std::move(value), is_constant, true});
        return;
    }
    const auto refuse = [&](std::string_view what)
    {
        throw ExpressionError(0, fmt::format("the variable '{}' already exists {}; it is {}", name,
                                             what, describe(*old)));
    };
    if (old->value.index() != value.index())
        refuse(is_text(*old) ? "and is a text" : "and is a number");
    if (old->is_constant != is_constant)
        refuse(old->is_constant ? "and is constant" : "and is not constant");
    if (old->value != value) refuse("with a different value");
}

void Variables::define_number(const std::string& name, std::string_view text, bool is_constant)
{
    define(name, evaluate_attribute(text, *this), is_constant);
}

void Variables::define_text(const std::string& name, std::string_view text, bool is_constant)
{
    define(name, interpolate(without_sign(text)), is_constant);
}

Variable& Variables::variable_to_set(const std::string& name)
{
    Variable* entry = find_entry(name);
    if (!entry)
        throw ExpressionError(
            0, fmt::format("the variable '{}' does not exist; define it first", name));
    if (entry->is_constant)
        throw ExpressionError(0, fmt::format("the variable '{}' is constant", name));
    return *entry;
}

void Variables::set_number(const std::string& name, std::string_view text)
{
    Variable& entry = variable_to_set(name);
    if (is_text(entry))
        throw ExpressionError(
            0, fmt::format("the variable '{}' is a text; expected a numeric variable", name));
    entry.value = evaluate_attribute(text, *this);
}

void Variables::set_text(const std::string& name, std::string_view text)
{
    Variable& entry = variable_to_set(name);
    if (!is_text(entry))
        throw ExpressionError(
            0, fmt::format("the variable '{}' is a number; expected a text variable", name));
    entry.value = interpolate(without_sign(text));
}

void Variables::erase(std::string_view patterns)
{
    std::vector<Variable> left = variables_;
    for (const std::string& pattern : split_list(patterns))
    {
        if (!is_pattern(pattern)) check_name(pattern);
        const std::size_t count =
            std::erase_if(left, [&](const Variable& v) { return matches(pattern, v.name); });
        if (count == 0 && !is_pattern(pattern))
            throw ExpressionError(0, fmt::format("the variable '{}' does not exist", pattern));
    }
    variables_ = std::move(left);
}

void Variables::save()
{
    saved_.push_back(variables_);
}

void Variables::load()
{
    if (saved_.empty()) return;
    variables_ = std::move(saved_.back());
    saved_.pop_back();
}

void Variables::choose_exported(std::string_view patterns)
{
    std::vector<std::string> entries = split_list(patterns);
    for (const std::string& entry : entries)
    {
        const bool needs_variable =
            !entry.starts_with('-') && !is_pattern(entry) && lower_case(entry) != "all";
        if (needs_variable && !find_entry(entry))
            throw ExpressionError(0, fmt::format("the variable '{}' is not defined", entry));
    }
    if (entries.empty()) return;
    if (!exported_names_)
    {
        exported_names_.emplace();
        if (entries.front().starts_with('-')) entries.insert(entries.begin(), "all");
    }
    for (std::string_view entry : entries)
    {
        const bool takes_out = entry.starts_with('-');
        if (takes_out) entry.remove_prefix(1);
        const bool is_all = lower_case(entry) == "all";
        for (const Variable& variable : variables_)
        {
            if (!is_all && !matches(entry, variable.name)) continue;
            if (takes_out)
                exported_names_->erase(variable.name);
            else
                exported_names_->insert(variable.name);
        }
    }
}

std::vector<Variable> Variables::exported() const
{
    std::vector<Variable> chosen;
    for (const Variable& variable : variables_)
    {
        const bool is_chosen = !exported_names_ || exported_names_->contains(variable.name);
        if (is_chosen && variable.is_exported) chosen.push_back(variable);
    }
    std::sort(chosen.begin(), chosen.end(),
              [](const Variable& a, const Variable& b)
              { return is_text(a) != is_text(b) ? is_text(a) : a.name < b.name; });
    return chosen;
}

std::string Variables::interpolate(std::string_view text) const
{
    // One entry an open bracket, and below them the finished text.
    std::vector<std::string> open(1);
    for (const char c : text)
    {
        if (c == '[')
            open.emplace_back();
        else if (c == ']' && open.size() > 1)
        {
            const std::string content = std::move(open.back());
            open.pop_back();
            if (content.empty())
                open.back() += "[]";
            else if (const Variable* variable = find_entry(content))
                open.back() += value_text(variable->value);
            else
                open.back() += format_number(evaluate_expression(content, *this, Blanks::Refused));
        }
        else
            open.back().push_back(c);
    }
    std::string result = open.front();
    for (std::size_t i = 1; i < open.size(); ++i) result.append("[").append(open[i]);
    return result;
}

std::string Variables::describe(const Variable& variable)
{
    const std::string_view quote = is_text(variable) ? "\"" : "";
    const std::string value = fmt::format("{0}{1}{0}", quote, value_text(variable.value));
    return variable.is_constant ? fmt::format("{}=[{}]", variable.name, value)
                                : fmt::format("{}={}", variable.name, value);
}

std::string Variables::describe_all() const
{
    std::string result;
    for (const Variable& variable : variables_)
    {
        if (!result.empty()) result += "  ";
        result += describe(variable);
    }
    return result;
}

} // namespace fppg
