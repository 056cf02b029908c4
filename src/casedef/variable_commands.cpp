#include "casedef/variable_commands.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{

void VariableCommands::assign(const std::string& command, const std::string& name,
                              const std::string& value)
{
    std::string text = value;
    if (command.starts_with("new"))
        for (const auto& [overridden, given] : overrides_)
            if (overridden == name)
            {
                text = given;
                used_.insert(name);
            }
    if (command == "newvar" || command == "newvarcte")
        variables_.define_number(name, text, command == "newvarcte");
    else if (command == "newvarstr" || command == "newvarstrcte")
        variables_.define_text(name, text, command == "newvarstrcte");
    else if (command == "setvar")
        variables_.set_number(name, text);
    else
        variables_.set_text(name, text);
}

void VariableCommands::print(const Element& e, std::vector<std::string>& printed) const
{
    for (const Element::Attribute& a : e.attributes)
        for (const Variable& v : variables_.all())
            if (v.name == a.name) printed.push_back(Variables::describe(v));
}

bool VariableCommands::run(const Element& e, std::vector<std::string>& printed)
{
    static const std::set<std::string> assignments{"newvar",    "newvarcte",    "setvar",
                                                   "newvarstr", "newvarstrcte", "setvarstr"};
    try
    {
        if (e.name == "varssave")
            variables_.save();
        else if (e.name == "varsload")
            variables_.load();
        else if (e.name == "delvar")
            variables_.erase(read_.text(e, "vars"));
        else if (e.name == "exportvar")
            variables_.choose_exported(read_.text(e, "vars"));
        else if (assignments.contains(e.name))
        {
            for (const Element::Attribute& a : e.attributes)
                if (Variables::is_variable_attribute(a.name)) assign(e.name, a.name, a.value);
            if (read_.flag_or(e, "_print", false)) print(e, printed);
        }
        else
            return false;
    }
    catch (const ExpressionError& error)
    {
        read_.fail(e, error.what());
    }
    return true;
}

void VariableCommands::require_all_overrides_used() const
{
    for (const auto& [name, value] : overrides_)
        if (!used_.contains(name))
            throw UsageError(fmt::format("-evars: the case defines no variable \"{}\"", name));
}

} // namespace fppg
