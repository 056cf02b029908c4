#include "upgrade/upgrade.h"

#include "upgrade/definition_text.h"
#include "upgrade/edited_text.h"

#include <algorithm>

namespace fppg
{

UpgradedDefinition upgrade_definition(const std::string& text, const std::string& path)
{
    UpgradedDefinition out;
    // New names first: no line moves by them, so that the lines told are those of the file.
    EditedText names(text, out);
    upgrade_names(scan_definition(text, path), path, names);
    const std::string renamed = names.apply();

    EditedText blocks(renamed, out);
    const TextNode root = scan_definition(renamed, path);
    upgrade_normals(root, blocks);
    upgrade_parameters(root, blocks);
    upgrade_special(root, blocks);
    out.text = blocks.apply();

    const auto by_line = [](const auto& a, const auto& b) { return a.line < b.line; };
    std::stable_sort(out.changes.begin(), out.changes.end(), by_line);
    std::stable_sort(out.notes.begin(), out.notes.end(), by_line);
    return out;
}

} // namespace fppg
