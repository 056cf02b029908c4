#pragma once

#include "fppg/element.h"

#include <string>

namespace fppg
{

/// Reads an XML file into a plain tree, as GenCase v5.4 does: runs of blanks in texts become one,
/// and a byte order mark, blanks and comments may stand before `<?xml` (DesignSPHysics writes a
/// comment there). A file that is not UTF-8 is taken as Latin-1. The declaration is not kept.
///
/// returns  an element without a name; its children are the root, whatever its name, and what
///          stands around it
/// throws   IoError if the file cannot be read; CaseError with the line where the XML breaks, or if
///          there is no root
Element read_document(const std::string& path);

/// As read_document, from text; `name` is what messages call it.
Element parse_document(std::string text, const std::string& name);

/// The root of a document.
const Element& root_of(const Element& document);

/// The root of a file or text; throws as read_document.
Element read_xml(const std::string& path);
Element parse_xml(std::string text, const std::string& name);

} // namespace fppg
