#pragma once

#include "fppg/element.h"
#include "fppg/vec.h"

#include "casedef/variables.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// A word of a list and the bits that it stands for.
struct Word
{
    std::string_view name;
    unsigned bits = 0;
};

/// Digits behind a sign, with zeros behind a point or without, blanks around them dropped; blanks
/// alone are 0. So GenCase v5.4.354 reads mk="1.0", "1.", "+1" and "" in all 20 attributes for
/// whole numbers that were tried. Nothing: the text is no such number.
std::optional<long long> whole_number(std::string_view text);

/// The bits of words joined by '|' (or) and '^' (exclusive or, so `all^top` is all without top),
/// taken from left to right, blanks around words dropped. No word gives 0. Found by experiment with
/// GenCase v5.4.354: 37 lists in boxfill, 27 in setshapemode, 17 in polyselec, 17 in boxfaces, 22
/// in mask, 13 in modefill, 10 in dirfilter.
///
/// bits_of  of one word; throws for a wrong one, which may be empty
unsigned sum_of_words(const std::string& list,
                      const std::function<unsigned(const std::string&)>& bits_of);

/// Reads the attributes and children of elements; every error names file, line, element, what was
/// found and what was expected. Numbers may be plain or `#expression` (rule V1).
class AttributeReader
{
public:
    AttributeReader(std::string file, const Variables& variables)
        : file_(std::move(file)), variables_(&variables)
    {
    }

    /// throws CaseError: "file:line: <element>: text"
    [[noreturn]] void fail(const Element& e, const std::string& text) const;

    /// An element that its parent does not know: the nearest known name is named, and all of them.
    [[noreturn]] void fail_unknown_element(const Element& e, std::string_view parent,
                                           const std::vector<std::string_view>& known) const;
    /// The same of an attribute.
    [[noreturn]] void fail_unknown_attribute(const Element& e, const Element::Attribute& a,
                                             const std::vector<std::string_view>& known) const;

    /// A command, attribute or value that GenCase knows and this program does not do yet.
    [[noreturn]] void fail_unsupported(const Element& e, const std::string& what = "") const;

    /// A text. Behind a `$` as its first character it is that without the `$`, each [expression] in
    /// it replaced; GenCase v5.4.354 so reads names of files, lists and properties, layers, formats
    /// and lists of mk (22 attributes tried).
    std::string text(const Element& e, std::string_view name) const;
    std::string text_or(const Element& e, std::string_view name,
                        const std::string& otherwise) const;

    double number(const Element& e, std::string_view name) const;
    double number_or(const Element& e, std::string_view name, double otherwise) const;
    std::optional<double> number_if(const Element& e, std::string_view name) const;

    /// A plain whole number within [min, max], "1.0" too, "" for 0; expressions only where
    /// `may_be_expression`.
    int integer(const Element& e, std::string_view name, int min, int max,
                bool may_be_expression) const;
    /// A flag, or an expression behind a '#', which is true unless it is 0.
    bool flag_or(const Element& e, std::string_view name, bool otherwise) const;
    /// A flag where GenCase v5.4 takes no expression: auto of constants and of setmknextauto,
    /// next, invert, printcall, reset and active of `<vres>`; it does in the 33 others of the
    /// templates (13 texts).
    bool plain_flag_or(const Element& e, std::string_view name, bool otherwise) const;

    /// Attributes x, y, z.
    Vec3 vec3(const Element& e) const;
    Vec3 vec3_or(const Element& e, const Vec3& otherwise) const;

    const Element& child(const Element& e, std::string_view name) const;
    /// Attributes x, y, z of a child.
    Vec3 child_vec3(const Element& e, std::string_view name) const { return vec3(child(e, name)); }
    /// Attribute `value` of a child.
    double child_value(const Element& e, std::string_view name) const
    {
        return number(child(e, name), "value");
    }
    /// All `<point>` children, `<pointN>` not included.
    std::vector<Vec3> points(const Element& e) const;

    /// Each word of the list must be in `known`, case included.
    unsigned word_bits(const Element& e, const std::string& list, const char* what,
                       const std::vector<Word>& known) const;

    /// A list like "1-3,5" of whole numbers from 0, or one expression behind a '#', cut to a whole
    /// number. Of lists with expressions in them GenCase v5.4 leaves numbers out: "#1,2" is 2.
    std::vector<std::uint16_t> number_list(const Element& e, std::string_view name) const;

    /// An attribute that is handed on: the number behind a '#', the text behind a '$', else as it
    /// stands.
    std::string evaluated(const Element& e, std::string_view name) const;

    /// Replaces [expressions] in a text.
    std::string interpolated(const Element& e, const std::string& text) const;

    /// False when an attribute `if` says so.
    bool is_active(const Element& e) const;

    const std::string& file() const { return file_; }

private:
    /// As it stands.
    const std::string& raw_text(const Element& e, std::string_view name) const;

    std::string file_;
    const Variables* variables_;
};

} // namespace fppg
