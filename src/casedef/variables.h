#pragma once

#include "casedef/expression.h"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// A variable of a case.
struct Variable
{
    std::string name;
    VariableValue value;
    bool is_constant = false;
    bool is_exported = true; ///< may go into <uservars>; false for Dp and other predefined ones
};

/// The variables of a case, in the order of their definition.
///
/// All rules were found by running GenCase v5.4.354; tests/casedef/variables_test.cpp holds them.
/// Every error is an ExpressionError that names the variable and what is expected of it; when it
/// comes from no expression its column is 0. A call that throws changes nothing.
///
/// The attributes of one command are executed from left to right, each at once: after A=1, B=2,
/// `<setvar A="B" B="A"/>` leaves 2 in both.
class Variables : public VariableSource
{
public:
    std::optional<VariableValue> find(std::string_view name) const override;
    RandomStream& random() const override { return random_; }

    /// Whether an attribute of a variable command is a variable. Only `if`, `_rem` and `_print` are
    /// not; other names beginning with `_` are, though expressions cannot hold them: they can be
    /// read as `[_name]` in texts alone.
    static bool is_variable_attribute(std::string_view attribute);

    /// Adds a variable that the program provides (Dp, PosMin_x, CaseName ...): a constant, and kept
    /// out of <uservars> unless is_exported (VResId is the one that is exported). It takes the
    /// place of a variable of that name, which must be of the same kind (`<predefinition>` may have
    /// one: 17 cases in GenCase v5.4.354).
    void predefine(const std::string& name, VariableValue value, bool is_exported = false);

    /// newvar and newvarcte. `text` is an expression, with or without a leading `#`.
    ///
    /// Defining a variable again is allowed if type, constancy and value (exactly) are the same.
    /// A name has letters (a to z), digits and `_`, and is none of all, none, true, false and e in
    /// any letter case. Names of functions are allowed; upper and lower case are different.
    void define_number(const std::string& name, std::string_view text, bool is_constant = false);

    /// newvarstr and newvarstrcte. `text` is interpolated first; a '$' as its first character is
    /// left out.
    void define_text(const std::string& name, std::string_view text, bool is_constant = false);

    /// setvar: the variable exists, is a number and no constant.
    void set_number(const std::string& name, std::string_view text);

    /// setvarstr: the variable exists, is a text and no constant; `text` as in define_text.
    void set_text(const std::string& name, std::string_view text);

    /// delvar vars="v5,Tex*,Size?": `*` is any number of characters, `?` exactly one, blanks do not
    /// count. Constants and predefined variables go too. A name without `*` and `?` must exist.
    void erase(std::string_view patterns);

    /// varssave: keeps a copy of all variables on a stack.
    void save();

    /// varsload: takes the last copy from the stack, with all that was added, changed or deleted
    /// since. An empty stack changes nothing.
    void load();

    /// exportvar vars="-all,Dp,PosMax*": chooses what exported() gives.
    ///
    /// The entries are applied in order, to the variables that exist now: `-` takes out, `all` (any
    /// letter case) is every variable. The first exportvar starts from all variables where its
    /// first entry takes out, else from none, the next ones from what is chosen; one without
    /// entries does nothing (28 cases in GenCase v5.4.354). A name without `*` and `?` that is to
    /// be exported must exist.
    void choose_exported(std::string_view patterns);

    /// The content of <uservars>: values of now, texts first, then numbers, each sorted by name
    /// (bytes). Predefined variables other than VResId are never in it, even when named. It is
    /// empty when nothing is chosen (then the file has no <uservars>); a case without variables of
    /// its own and without exportvar has VResId in it.
    std::vector<Variable> exported() const;

    /// Replaces each `[...]` of a text: by the variable's text or number if the whole is the name
    /// of a variable, else by the number that the expression gives, with six significant digits.
    ///
    /// Inner brackets are replaced first, as text, so `[x[i+1]]` is the variable x2 for i = 1.
    /// Blanks are refused within brackets. `[]`, a `]` without `[` and a `[` without `]` stay as
    /// they are; there is no escape, and `\n` stays two characters. What a variable brings in is
    /// not searched again for a `[`.
    std::string interpolate(std::string_view text) const;

    /// All variables in order of definition.
    const std::vector<Variable>& all() const { return variables_; }

    /// As GenCase prints it: `A=1`, `S="text"`, and for constants `A=[1]`, `S=["text"]`.
    static std::string describe(const Variable& variable);

    /// All variables in order of definition as `List of available variables:` prints them, with two
    /// blanks between.
    std::string describe_all() const;

private:
    Variable* find_entry(std::string_view name);
    const Variable* find_entry(std::string_view name) const;
    Variable& variable_to_set(const std::string& name);
    void define(const std::string& name, VariableValue value, bool is_constant);

    std::vector<Variable> variables_;
    std::vector<std::vector<Variable>> saved_;
    std::optional<std::set<std::string>> exported_names_; ///< empty without exportvar: all
    mutable RandomStream random_; ///< rand changes it, which is no change of a variable
};

} // namespace fppg
