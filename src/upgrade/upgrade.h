#pragma once

#include <string>
#include <vector>

namespace fppg
{

struct UpgradeChange
{
    int line = 0;     ///< in the text before, from 1
    std::string from; ///< one line
    std::string to;   ///< one line
};

/// What a person has to decide.
struct UpgradeNote
{
    int line = 0; ///< in the text before, from 1
    std::string text;
};

struct UpgradedDefinition
{
    std::string text;
    std::vector<UpgradeChange> changes; ///< by line
    std::vector<UpgradeNote> notes;     ///< by line
};

/// Writes a case definition in the forms of DualSPHysics v5.4. Only the bytes of old forms change;
/// comments, order, indentation and line ends stay. An old form is changed
/// - where v5.4 reads the new form as it reads the old one, so that it makes the same of both;
/// - where GenCase or the solver of v5.4 refuses the old form, to what it meant.
/// An old form that v5.4 passes over is left and noted, for to change it would change the run.
/// Upgraded once more nothing changes.
///
/// path    of the definition, for messages, the name of the case and the files beside it; it is
///         not read
/// throws  CaseError if the elements cannot be told apart or the root is not <case>
UpgradedDefinition upgrade_definition(const std::string& text, const std::string& path);

} // namespace fppg
