#include "upgrade/edited_text.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace fppg
{
namespace
{

/// What a person has to rewrite, by the source of v5.4's solver.
struct Obsolete
{
    std::string_view path; ///< in `<special>`
    std::string_view text;
};

constexpr Obsolete obsolete[] = {
    {"boundcorr", "v5.4's solver refuses it; mDBC (Boundary=2, <normals>) took its place"},
    {"boundextrap", "v5.4's solver refuses it; mDBC (Boundary=2, <normals>) took its place"},
    {"inout/userefilling", "v5.4's solver refuses it; each <inoutzone> has <refilling>"},
    {"inout/inoutzone/userefilling", "v5.4's solver refuses it; <refilling> took its place"},
    {"inout/inoutzone/convertfluid", "v5.4's solver refuses it; <inputtreatment> took its place"},
    {"structures", "v5.4 does not look at it; <flexstrucs> took its place"},
    {"flexiblestructures", "v5.4 does not look at it; <flexstrucs> took its place"},
};

void note_obsolete(const TextNode& node, std::string_view path, std::string_view text,
                   EditedText& edited)
{
    const std::size_t end = std::min(path.find('/'), path.size());
    for (const TextNode* child : active_children(node, path.substr(0, end)))
        if (end < path.size())
            note_obsolete(*child, path.substr(end + 1), text, edited);
        else
            edited.note(child->line, fmt::format("<{}>: {}", child->name, text));
}

/// The mk of an input of accelerations: an element before v5.0, an attribute since.
void upgrade_acceleration_inputs(const TextNode& inputs, EditedText& edited)
{
    for (const TextNode* input : active_children(inputs, "accinput"))
    {
        const TextNode* mk = input->find("mkfluid");
        if (mk == nullptr) continue;
        const TextAttribute* value = mk->find_attribute("value");
        if (value == nullptr || input->find_attribute("mkfluid") != nullptr ||
            input->find_attribute("mkbound") != nullptr ||
            active_children(*input, "mkfluid").size() > 1)
        {
            edited.note(mk->line,
                        "<mkfluid>: v5.4's solver refuses it; it is an attribute of "
                        "<accinput> now");
            continue;
        }
        edited.insert(input->name_at.end, fmt::format(" mkfluid=\"{}\"", value->value));
        edited.remove(*mk);
        edited.report(mk->line, fmt::format("<accinput> <mkfluid value=\"{}\">", value->value),
                      fmt::format("<accinput mkfluid=\"{}\">", value->value));
    }
}

/// The threads of Chrono stood in its `<collision>`; v5.4's solver refuses them there where
/// collisions are activated, and does not look there where they are not.
void upgrade_chrono_threads(const TextNode& chrono, EditedText& edited)
{
    const TextNode* collision = chrono.find("collision");
    const TextNode* threads = collision == nullptr ? nullptr : collision->find("ompthreads");
    if (threads == nullptr) return;
    const TextAttribute* activated = collision->find_attribute("activate");
    if (activated == nullptr || !is_true(activated->value)) return;
    if (chrono.find("ompthreads") != nullptr)
    {
        edited.rename(*threads, "_ompthreads");
        edited.report(threads->line, "<collision> <ompthreads>",
                      "<collision> <_ompthreads>, for <chrono> has <ompthreads>");
        return;
    }
    const auto indent = edited.indent_at(collision->whole.begin);
    const std::string line =
        indent ? edited.line_end(collision->whole.end) + *indent : std::string();
    edited.insert(collision->whole.end, line + edited.part(threads->whole));
    edited.remove(*threads);
    edited.report(threads->line, "<chrono> <collision> <ompthreads>", "<chrono> <ompthreads>");
}

} // namespace

void upgrade_special(const TextNode& root, EditedText& edited)
{
    const TextNode* special = find_active(root, "execution/special");
    if (special == nullptr) return;
    for (const Obsolete& o : obsolete) note_obsolete(*special, o.path, o.text, edited);
    if (const TextNode* inputs = special->find("accinputs"))
        upgrade_acceleration_inputs(*inputs, edited);
    if (const TextNode* chrono = special->find("chrono")) upgrade_chrono_threads(*chrono, edited);
}

} // namespace fppg
