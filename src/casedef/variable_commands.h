#pragma once

#include "casedef/attributes.h"
#include "casedef/variables.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// Executes newvar, newvarcte, setvar, newvarstr, newvarstrcte, setvarstr, delvar, exportvar,
/// varssave and varsload, with the values that -evars puts in place of those in the case.
class VariableCommands
{
public:
    VariableCommands(Variables& variables, const AttributeReader& read,
                     std::vector<std::pair<std::string, std::string>> overrides)
        : variables_(variables), read_(read), overrides_(std::move(overrides))
    {
    }

    /// returns  false when the element is no such command
    /// throws   CaseError
    bool run(const Element& e, std::vector<std::string>& printed);

    /// throws UsageError when -evars named a variable that the case does not define
    void require_all_overrides_used() const;

private:
    /// Appends the values of the variables that an element assigns.
    void print(const Element& e, std::vector<std::string>& printed) const;
    void assign(const std::string& command, const std::string& name, const std::string& value);

    Variables& variables_;
    const AttributeReader& read_;
    std::vector<std::pair<std::string, std::string>> overrides_;
    std::set<std::string> used_;
};

} // namespace fppg
