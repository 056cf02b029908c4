#pragma once

#include "fppg/element.h"

#include <string>

namespace fppg
{

/// Reads an XML file into a plain tree.
///
/// A byte order mark, blanks and comments before `<?xml` are skipped: DesignSPHysics writes a
/// comment there, and GenCase reads it.
///
/// returns  the root element, whatever its name; text that stands between elements is dropped
/// throws   IoError if the file cannot be read; CaseError with the line where the XML breaks
Element read_xml(const std::string& path);

/// As read_xml, from text; `name` is what messages call it.
Element parse_xml(std::string text, const std::string& name);

} // namespace fppg
