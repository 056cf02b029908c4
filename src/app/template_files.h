#pragma once

#include <span>
#include <string_view>

namespace fppg
{

/// A file of xml-templates/, built in, so that the program needs no file beside it.
struct TemplateFile
{
    std::string_view path; ///< from that folder on, e.g. "data/part.stl"
    std::string_view bytes;
};

/// The case templates, the files that they read, the schema and the page about them, by name.
std::span<const TemplateFile> template_files();

} // namespace fppg
