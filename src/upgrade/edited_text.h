#pragma once

#include "upgrade/definition_text.h"
#include "upgrade/upgrade.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// A definition, and the edits that a rule makes to it. Edits may touch but not overlap; what is
/// inserted at one place stands in the order of the calls.
class EditedText
{
public:
    /// out  takes the changes and notes; its text is not looked at
    EditedText(const std::string& text, UpgradedDefinition& out) : text_(text), out_(out) {}

    const std::string& text() const { return text_; }
    std::string part(TextSpan span) const
    {
        return text_.substr(span.begin, span.end - span.begin);
    }

    void replace(TextSpan span, std::string with) { edits_.push_back({span, std::move(with)}); }
    void insert(std::size_t at, std::string what) { replace({at, at}, std::move(what)); }
    /// Start and end tag.
    void rename(const TextNode& node, const std::string& name);
    /// With the blanks before it.
    void remove(const TextAttribute& attribute);
    /// With its line, where nothing else stands on it.
    void remove(const TextNode& node);

    void report(int line, const std::string& from, const std::string& to);
    void note(int line, const std::string& text);

    /// The blanks before `at`, where there is nothing else before it on its line.
    std::optional<std::string> indent_at(std::size_t at) const;
    /// One step of the indentation: from the node to its first child on a line of its own.
    std::string indent_step(const TextNode& node) const;
    /// Of the line of that byte: "\r\n" or "\n".
    std::string line_end(std::size_t at) const;

    std::string apply() const;

private:
    struct Edit
    {
        TextSpan span;
        std::string with;
    };

    const std::string& text_;
    UpgradedDefinition& out_;
    std::vector<Edit> edits_;
};

/// The number, where the value is one and no expression ("#...").
std::optional<double> literal_number(const std::string& value);
/// "1" or "true" in any case of letters, as GenCase v5.4 reads flags.
bool is_true(const std::string& value);
/// True but for active="false" or "0".
bool is_switched_on(const TextNode& node);

/// The active elements of that name in a node.
std::vector<const TextNode*> active_children(const TextNode& node, std::string_view name);
/// The first active element along a path such as "execution/special", or nullptr.
const TextNode* find_active(const TextNode& node, std::string_view path);

/// The rules, by the part of a definition. Names leave every line where it is.
void upgrade_names(const TextNode& root, const std::string& path, EditedText& edited);
void upgrade_normals(const TextNode& root, EditedText& edited);
void upgrade_parameters(const TextNode& root, EditedText& edited);
void upgrade_special(const TextNode& root, EditedText& edited);

} // namespace fppg
