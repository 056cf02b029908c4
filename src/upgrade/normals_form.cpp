#include "upgrade/edited_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace fppg
{
namespace
{

using Names = std::vector<std::string_view>;

bool holds(const Names& names, std::string_view name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// The old form of `<normals>`, which holds what `<norgeometry>` holds now. Found with GenCase
/// v5.4.354, which still reads it and warns: distanceh, maxsizeh and svshapes give their value as
/// `value` there and as `v` in the new form, each passing over the other; svnormals is passed over
/// in the old form and refused in the new one, the others for debugging are refused in both. It
/// computes normals of floating bodies too, as ftsupport="1" asked for.
class NormalsUpgrade
{
public:
    explicit NormalsUpgrade(EditedText& edited) : edited_(edited) {}

    void run(const TextNode& normals)
    {
        if (normals.find("geometryfile") == nullptr)
        {
            note_passed_over(normals);
            return;
        }
        static const Names known{"geometryfile", "distanceh", "maxsizeh", "svshapes"};
        static const Names off{"svnormals", "svnormaldata",    "computenormals",
                               "ftsupport", "dg_svopenshapes", "dg_svpartsnormal"};
        for (const TextNode& child : normals.children)
        {
            const bool is_twice = active_children(normals, child.name).size() > 1;
            if (child.is_active() && !holds(off, child.name) &&
                (!holds(known, child.name) || is_twice))
            {
                edited_.note(child.line,
                             fmt::format("<{}>: GenCase v5.4 refuses it here, so that <normals> "
                                         "is left as it is",
                                         child.name));
                return;
            }
        }
        for (const TextNode& child : normals.children)
        {
            if (!child.is_active()) continue;
            if (holds(off, child.name))
                switch_off(child);
            else if (child.name != "geometryfile")
                upgrade_value(child);
        }
        wrap(normals);
    }

private:
    void note_passed_over(const TextNode& normals)
    {
        const TextNode* geometry = normals.find("norgeometry");
        if (geometry == nullptr) return;
        for (const TextNode& child : geometry->children)
            if (child.is_active() && child.find_attribute("value") != nullptr &&
                child.find_attribute("v") == nullptr)
                edited_.note(child.line,
                             fmt::format("<{}>: v5.4 reads \"v\" and passes over \"value\" here",
                                         child.name));
    }

    void switch_off(const TextNode& child)
    {
        edited_.rename(child, "_" + child.name);
        edited_.report(child.line, fmt::format("<{}>", child.name),
                       fmt::format("<_{}>", child.name));
        const TextAttribute* value = child.find_attribute("value");
        if (child.name == "ftsupport" && value != nullptr && !is_true(value->value))
            edited_.note(child.line,
                         "<ftsupport>: v5.4 computes the normals of floating bodies too");
    }

    void upgrade_value(const TextNode& child)
    {
        if (const TextAttribute* passed_over = child.find_attribute("v"))
        {
            edited_.remove(*passed_over);
            edited_.report(child.line,
                           fmt::format("<{} {}>", child.name, edited_.part(passed_over->whole)),
                           fmt::format("<{}>", child.name));
        }
        const TextAttribute* value = child.find_attribute("value");
        if (value == nullptr) return;
        edited_.replace(value->name_at, "v");
        edited_.report(child.line, fmt::format("<{} {}>", child.name, edited_.part(value->whole)),
                       fmt::format("<{} v=\"{}\">", child.name, value->value));
    }

    void wrap(const TextNode& normals)
    {
        const TextNode& first = normals.children.front();
        const TextNode& last = normals.children.back();
        const auto indent = edited_.indent_at(first.whole.begin);
        if (indent)
        {
            const std::string step = edited_.indent_step(normals);
            edited_.insert(first.whole.begin - indent->size(),
                           *indent + "<norgeometry>" + edited_.line_end(first.whole.begin));
            for (const TextNode& child : normals.children)
                if (const auto blanks = edited_.indent_at(child.whole.begin)) shift(child, step);
            edited_.insert(last.whole.end,
                           edited_.line_end(last.whole.end) + *indent + "</norgeometry>");
        }
        else
        {
            edited_.insert(first.whole.begin, "<norgeometry>");
            edited_.insert(last.whole.end, "</norgeometry>");
        }
        edited_.report(normals.line, "<normals>", "<normals> <norgeometry>");
    }

    /// One step to the right, with what stands on lines of its own inside.
    void shift(const TextNode& node, const std::string& step)
    {
        edited_.insert(node.whole.begin, step);
        for (const TextNode& child : node.children)
            if (edited_.indent_at(child.whole.begin)) shift(child, step);
        if (!node.is_comment && !node.is_one_tag && edited_.indent_at(node.inside.end))
            edited_.insert(node.inside.end, step);
    }

    EditedText& edited_;
};

/// The normals that the solver of v5.0 and v5.2 computed by itself, `<initialize><boundnormal_*>`,
/// which the solver of v5.4 refuses: GenCase v5.4 computes them in `<normals>`. The names inside
/// are the same; so are the normals of planes, spheres and cylinders (four, two and two cases of
/// 487 particles against the formulas of the old solver's source, to the rounding of single
/// precision; but see note_point()). A plane without mkbound selects nothing in both.
class BoundNormalsUpgrade
{
public:
    explicit BoundNormalsUpgrade(EditedText& edited) : edited_(edited) {}

    void run(const TextNode& root)
    {
        const TextNode* initialize = find_active(root, "execution/special/initialize");
        if (initialize == nullptr) return;
        std::vector<const TextNode*> moved;
        bool is_refused = false;
        for (const TextNode& child : initialize->children)
        {
            if (!child.is_active() || !child.name.starts_with("boundnormal_")) continue;
            moved.push_back(&child);
            is_refused = is_refused || child.name != "boundnormal_set";
            if (!is_known(child)) return;
        }
        // boundnormal_set alone is still the solver's, which sets it last.
        if (!is_refused) return;
        const TextNode* definition = root.find("casedef");
        if (definition == nullptr) return;
        const TextNode* normals = definition->find("normals");
        if (normals != nullptr && !is_switched_on(*normals))
        {
            edited_.note(moved.front()->line,
                         fmt::format("<{}>: v5.4's solver refuses it, and <normals>, where it "
                                     "belongs now, is switched off",
                                     moved.front()->name));
            return;
        }
        outer_indent_ = outer_indent(*definition, normals);
        const std::string inner =
            outer_indent_.value_or("") + edited_.indent_step(normals ? *normals : *definition);
        for (const TextNode* node : moved) move(*node, inner);
        insert_moved(*definition, normals);
        take_out(*initialize, moved);
    }

private:
    bool is_known(const TextNode& node) const
    {
        static const std::array<std::pair<std::string_view, Names>, 5> known{{
            {"boundnormal_set", {"onlypos", "normal"}},
            {"boundnormal_plane", {"onlypos", "point", "limitdist", "normal", "maxdisth", "clear"}},
            {"boundnormal_sphere", {"onlypos", "center", "radius", "inside", "maxdisth", "clear"}},
            {"boundnormal_cylinder",
             {"onlypos", "center1", "center2", "radius", "inside", "limit1", "limit2", "maxdisth",
              "clear"}},
            {"boundnormal_parts", {"maxdisth"}},
        }};
        const auto* found = std::find_if(known.begin(), known.end(),
                                         [&](const auto& k) { return k.first == node.name; });
        const auto refuses = [&](const TextNode& c)
        { return c.is_active() && !holds(found->second, c.name); };
        if (found != known.end() &&
            std::none_of(node.children.begin(), node.children.end(), refuses))
            return true;
        edited_.note(node.line, fmt::format("<{}>: v5.4 does not know it as it stands; <normals> "
                                            "of v5.4 has norset, norplane, norsphere, norcylinder "
                                            "and norparts",
                                            node.name));
        return false;
    }

    static std::string new_name(const TextNode& node)
    {
        return "nor" + node.name.substr(node.name.find('_') + 1);
    }

    /// Of the line on which `<normals>` ends or will end, where it has that line for itself.
    std::optional<std::string> outer_indent(const TextNode& definition,
                                            const TextNode* normals) const
    {
        if (normals == nullptr)
        {
            auto indent = edited_.indent_at(definition.inside.end);
            if (indent) *indent += edited_.indent_step(definition);
            return indent;
        }
        return edited_.indent_at(normals->is_one_tag ? normals->whole.begin : normals->inside.end);
    }

    void move(const TextNode& node, const std::string& inner_indent)
    {
        std::string text = edited_.part(node.whole);
        const auto rename = [&](TextSpan at)
        { text.replace(at.begin - node.whole.begin, at.end - at.begin, new_name(node)); };
        if (!node.is_one_tag) rename(node.end_name_at);
        rename(node.name_at);
        if (outer_indent_)
        {
            const auto own = edited_.indent_at(node.whole.begin);
            if (own) text = indented(text, *own, inner_indent);
            text = inner_indent + text + edited_.line_end(node.whole.end);
        }
        moved_text_ += text;
        note_point(node);
        const TextAttribute* mk = node.find_attribute("mkbound");
        const std::string attribute = mk == nullptr ? "" : " " + edited_.part(mk->whole);
        edited_.report(node.line, fmt::format("<initialize> <{}{}>", node.name, attribute),
                       fmt::format("<normals> <{}{}>", new_name(node), attribute));
    }

    /// The old solver found the automatic point of an oblique plane from all particles of the mk,
    /// GenCase v5.4 from those in onlypos.
    void note_point(const TextNode& node)
    {
        const TextNode* point = node.find("point");
        const TextNode* normal = node.find("normal");
        const TextAttribute* automatic = point == nullptr ? nullptr : point->find_attribute("auto");
        if (automatic == nullptr || !is_true(automatic->value) || normal == nullptr ||
            node.find("onlypos") == nullptr)
            return;
        const auto is_zero = [](const TextAttribute& a) { return literal_number(a.value) == 0.0; };
        if (std::count_if(normal->attributes.begin(), normal->attributes.end(),
                          [&](const TextAttribute& a)
                          { return a.name.size() == 1 && !is_zero(a); }) < 2)
            return;
        edited_.note(point->line,
                     "<point auto>: v5.4 finds the point from the particles in "
                     "<onlypos>, the solver before it from all of the mk");
    }

    /// Lines that begin with the blanks `before` begin with `after` instead.
    static std::string indented(const std::string& text, const std::string& before,
                                const std::string& after)
    {
        std::string out;
        for (std::size_t at = 0; at < text.size();)
        {
            const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
            std::string line = text.substr(at, end - at);
            if (at > 0 && line.starts_with(before)) line.replace(0, before.size(), after);
            out += line;
            at = end;
        }
        return out;
    }

    void insert_moved(const TextNode& definition, const TextNode* normals)
    {
        const TextNode& outer_node = normals != nullptr ? *normals : definition;
        const std::string outer = outer_indent_.value_or("");
        const std::string end = outer_indent_ ? edited_.line_end(outer_node.start_tag.end) : "";
        if (normals != nullptr && normals->is_one_tag)
        {
            std::size_t slash = normals->whole.end - 2;
            while (edited_.text()[slash - 1] == ' ') --slash;
            edited_.replace({slash, normals->whole.end},
                            ">" + end + moved_text_ + outer + "</normals>");
            return;
        }
        // Before the line of the end tag.
        const std::size_t closing = outer_node.inside.end;
        const std::size_t at = closing - edited_.indent_at(closing).value_or("").size();
        edited_.insert(at, normals != nullptr ? moved_text_
                                              : outer + "<normals>" + end + moved_text_ + outer +
                                                    "</normals>" + end);
    }

    /// `<initialize>` goes too, where nothing is left in it.
    void take_out(const TextNode& initialize, const std::vector<const TextNode*>& moved)
    {
        if (moved.size() == initialize.children.size())
        {
            edited_.remove(initialize);
            return;
        }
        for (const TextNode* node : moved) edited_.remove(*node);
    }

    EditedText& edited_;
    std::optional<std::string> outer_indent_;
    std::string moved_text_;
};

} // namespace

void upgrade_normals(const TextNode& root, EditedText& edited)
{
    if (const TextNode* normals = find_active(root, "casedef/normals"))
        NormalsUpgrade(edited).run(*normals);
    BoundNormalsUpgrade(edited).run(root);
}

} // namespace fppg
