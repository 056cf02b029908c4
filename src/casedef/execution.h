#pragma once

#include "casedef/attributes.h"

#include "fppg/vec.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// Visits the children of an element that the solver reads: those that are not switched off.
template <typename Visit>
void for_each_read(const Element& e, const Visit& visit)
{
    for (const Element& child : e.children)
    {
        const std::string* active = child.find_attribute("active");
        const bool is_off = active != nullptr && (*active == "false" || *active == "0");
        if (child.kind == Element::Kind::Tag && !child.name.starts_with('_') && !is_off)
            visit(child);
    }
}

/// Visits what the solver reads of a list in `<special>`: inout, flexstrucs, ...
template <typename Visit>
void for_each_special(const std::vector<Element>& execution, std::string_view list,
                      const Visit& visit)
{
    for (const Element& special : execution)
        if (special.kind == Element::Kind::Tag && special.name == "special")
            for_each_read(special,
                          [&](const Element& e)
                          {
                              if (e.name == list) for_each_read(e, visit);
                          });
}

/// What Case.xml takes over from `<execution>`: its children without those that this program writes
/// itself, so that a generated Case.xml is a valid definition again.
///
/// throws CaseError without `<parameters>`, or with more than two of them: GenCase v5.4 joins the
///        second with the first and leaves the others, which DualSPHysics does not read
std::vector<Element> read_execution(const Element& root, const AttributeReader& read);

/// Puts values in the place of `#expression` and `$text with [expressions]`, in the values of the
/// first `<parameters>` and in all attributes of the first `<special>`, comments and disabled
/// elements too, nowhere else; completes the limits of `<simulationdomain>`. With the values that
/// variables have now: GenCase v5.4 does so at its end (60 experiments).
///
/// throws CaseError for what GenCase refuses there: other elements in `<parameters>`, a second
///        `<simulationdomain>`, wrong limits and expressions
void evaluate_execution(std::vector<Element>& execution, const AttributeReader& read);

/// The value of a parameter of the solver; empty where the case does not give it.
std::optional<std::string> parameter_value(const std::vector<Element>& execution,
                                           std::string_view key);

/// The axes along which the solver repeats the case, and the shift of the next copy across each:
/// parameters XPeriodicIncY and the like, or XYPeriodic, XZPeriodic, YZPeriodic (JSph.cpp, v5.4).
///
/// throws CaseError for a value that is no number
void read_periodic_axes(const std::vector<Element>& execution, const std::string& file,
                        std::array<bool, 3>& is_periodic, std::array<Vec3, 3>& shift);

/// A limit of a simulation domain as GenCase v5.4 writes it: a number as it stands, `default`,
/// `default - NUMBER` or `default - NUMBER%`, with + at the upper limit; blanks and capitals do not
/// matter (50 texts).
///
/// throws CaseError for other texts
std::string domain_limit(const AttributeReader& read, const Element& e, const std::string& text,
                         bool is_min);

} // namespace fppg
