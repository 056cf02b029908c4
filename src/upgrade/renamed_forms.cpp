#include "upgrade/edited_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace fppg
{
namespace
{

/// An element that v5.4 calls otherwise, anywhere inside `section`.
struct Renaming
{
    std::string_view section;
    std::string_view old_name;
    std::string_view new_name;
    bool may_repeat; ///< several of the new name may stand side by side
};

/// Found by giving each old name to GenCase v5.4.354: it writes mvpredef and mvfile as mvrectfile,
/// takes coefficient for coefh, and refuses the four of floatings. Those of the solver are told by
/// its source: both names of relaxation zones and of the moorings' output are read, moordyn and
/// datafile refused.
constexpr Renaming renamings[] = {
    {"casedef/constantsdef", "coefficient", "coefh", false},
    {"casedef/motion", "mvpredef", "mvrectfile", true},
    {"casedef/motion", "mvfile", "mvrectfile", true},
    {"casedef/floatings", "velini", "linearvelini", false},
    {"casedef/floatings", "omegaini", "angularvelini", false},
    {"casedef/floatings", "translation", "translationDOF", false},
    {"casedef/floatings", "rotation", "rotationDOF", false},
    {"execution/special/accinputs", "datafile", "acctimesfile", false},
    {"execution/special/moorings", "moordyn", "moordynplus", false},
    {"execution/special/moorings/moordyn", "output", "savedata", false},
    {"execution/special/relaxationzones", "rzwaves_uniform", "rz_uniform", true},
};

class NameUpgrade
{
public:
    NameUpgrade(const std::string& path, EditedText& edited) : path_(path), edited_(edited)
    {
        case_name_ = path_.stem().string();
        if (case_name_.size() > 4 && case_name_.ends_with("_Def"))
            case_name_.resize(case_name_.size() - 4);
    }

    void run(const TextNode& root)
    {
        for (const Renaming& renaming : renamings)
            if (const TextNode* section = find_active(root, renaming.section))
                rename_in(*section, renaming);
        if (const TextNode* definition = root.find("casedef"))
        {
            upgrade_shape_modes(*definition);
            upgrade_constant_variables(*definition);
        }
        upgrade_shape_files(root);
    }

private:
    void rename_in(const TextNode& node, const Renaming& renaming)
    {
        for (const TextNode& child : node.children)
        {
            if (!child.is_active()) continue;
            if (child.name == renaming.old_name)
                rename(node, child, renaming);
            else
                rename_in(child, renaming);
        }
    }

    void rename(const TextNode& parent, const TextNode& child, const Renaming& renaming)
    {
        const auto alike = active_children(parent, renaming.old_name).size() +
                           active_children(parent, renaming.new_name).size();
        if (!renaming.may_repeat && alike > 1)
        {
            edited_.note(child.line, fmt::format("<{}> is called <{}> now, and <{}> has more than "
                                                 "one of the two: keep one",
                                                 child.name, renaming.new_name, parent.name));
            return;
        }
        edited_.rename(child, std::string(renaming.new_name));
        edited_.report(child.line, fmt::format("<{}>", child.name),
                       fmt::format("<{}>", renaming.new_name));
    }

    /// GenCase v5.4 takes "real", in lower case only, for "actual".
    void upgrade_shape_modes(const TextNode& node)
    {
        for (const TextNode& child : node.children)
        {
            if (!child.is_active()) continue;
            upgrade_shape_modes(child);
            if (child.name != "setshapemode") continue;
            // What GenCase reads of it.
            const TextSpan text{child.inside.begin, child.children.empty()
                                                        ? child.inside.end
                                                        : child.children.front().whole.begin};
            const std::string before = edited_.part(text);
            const auto words = words_of(before);
            const auto is = [&](std::string_view name)
            {
                return std::any_of(
                    words.begin(), words.end(),
                    [&](TextSpan word)
                    { return before.substr(word.begin, word.end - word.begin) == name; });
            };
            if (!is("real")) continue;
            if (!child.children.empty())
            {
                edited_.note(child.line,
                             "<setshapemode> has a comment inside, behind which GenCase v5.4 does "
                             "not read; write \"actual\" for \"real\"");
                continue;
            }
            std::string after;
            std::size_t at = 0;
            bool has_actual = is("actual");
            for (const TextSpan word : words)
            {
                if (before.substr(word.begin, word.end - word.begin) != "real") continue;
                after.append(before, at, word.begin - at);
                // One of the two is enough; the bar behind it goes with it.
                if (!has_actual) after += "actual";
                at = word.end;
                if (has_actual) at = without_bar(before, at, after);
                has_actual = true;
            }
            after.append(before, at);
            edited_.replace(child.inside, after);
            edited_.report(child.line, fmt::format("<setshapemode>{}", before),
                           fmt::format("<setshapemode>{}", after));
        }
    }

    /// The words between the bars.
    static std::vector<TextSpan> words_of(const std::string& list)
    {
        constexpr std::string_view no_word = "| \t\r\n";
        std::vector<TextSpan> words;
        for (std::size_t at = 0;;)
        {
            const std::size_t begin = list.find_first_not_of(no_word, at);
            if (begin == std::string::npos) return words;
            at = std::min(list.find_first_of(no_word, begin), list.size());
            words.push_back({begin, at});
        }
    }

    /// Past the bar behind a word taken out, or, behind the last word, takes off the bar before it.
    static std::size_t without_bar(const std::string& list, std::size_t at, std::string& before)
    {
        const std::size_t next = list.find_first_not_of(" \t\r\n", at);
        if (next != std::string::npos && list[next] == '|')
            return std::min(list.find_first_not_of(" \t\r\n", next + 1), list.size());
        const std::size_t bar = before.rfind('|');
        if (bar != std::string::npos) before.resize(bar);
        while (before.ends_with(' ')) before.pop_back();
        return at;
    }

    /// `_cte` made variables of newvar constant before there was newvarcte; GenCase v5.4 still
    /// knows it, with 0, 1, true and false.
    void upgrade_constant_variables(const TextNode& node)
    {
        for (const TextNode& child : node.children)
        {
            if (!child.is_active()) continue;
            upgrade_constant_variables(child);
            const TextAttribute* constant = child.find_attribute("_cte");
            if ((child.name != "newvar" && child.name != "newvarstr") || constant == nullptr ||
                !is_true(constant->value))
                continue;
            edited_.rename(child, child.name + "cte");
            edited_.remove(*constant);
            edited_.report(child.line,
                           fmt::format("<{} {}>", child.name, edited_.part(constant->whole)),
                           fmt::format("<{}cte>", child.name));
        }
    }

    /// GenCase v5.4 writes CASE_name_Actual.vtk, where GenCase v4 wrote CASE_name_Real.vtk.
    void upgrade_shape_files(const TextNode& node)
    {
        for (const TextNode& child : node.children)
        {
            if (!child.is_active()) continue;
            upgrade_shape_files(child);
            for (const TextAttribute& a : child.attributes)
                if (names_own_shapes(a))
                {
                    std::string value = a.value;
                    value.replace(value.size() - ending.size(), ending.size(), "_Actual.vtk");
                    edited_.report(child.line,
                                   fmt::format("<{}> {}=\"{}\"", child.name, a.name, a.value),
                                   fmt::format("{}=\"{}\"", a.name, value));
                    edited_.replace(a.value_at, std::move(value));
                }
        }
    }

    /// Files that are there were not written by this case.
    bool names_own_shapes(const TextAttribute& a) const
    {
        if ((a.name != "file" && a.name != "modelfile") || !a.value.ends_with(ending)) return false;
        std::error_code ignored;
        return (a.value.starts_with("[CaseName]_") || a.value.starts_with(case_name_ + "_")) &&
               !std::filesystem::exists(path_.parent_path() / a.value, ignored);
    }

    static constexpr std::string_view ending = "_Real.vtk";

    std::filesystem::path path_;
    std::string case_name_;
    EditedText& edited_;
};

} // namespace

void upgrade_names(const TextNode& root, const std::string& path, EditedText& edited)
{
    NameUpgrade(path, edited).run(root);
}

} // namespace fppg
