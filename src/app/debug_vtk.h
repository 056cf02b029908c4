#pragma once

#include "fppg/case_def.h"
#include "fppg/files.h"

#include <functional>
#include <string>
#include <vector>

namespace fppg
{

/// A file that shows what a command read, for looking at only.
struct DebugVtk
{
    std::string name; ///< behind the case name
    std::function<void(OutputFile&)> write;
};

/// The pictures of a case, as GenCase v5.4.354 writes them, whatever `-save` says:
/// - `_dbg-fillbox.vtk`, `_dbg-redrawbox.vtk`, `_dbg-redrawnearbox.vtk`: the boxes of all such
///   commands, as shape files with object 0; fillbox also a cross of 2 dp at each seed
/// - `_Dbg_NAME_BthPoints.vtk`, `_Dbg_NAME_BthGrid.vtk` for `<savepoints value="true" />` and
///   `<savegrid>` of drawbathymetry: the nodes of its grid as vertices, or its cells as quads, in
///   doubles, with an array Height, before the matrix. NAME is that of the file without folder and
///   ending; of two such commands with one name the later one counts
///
/// threads  for reading the points of a bathymetry
std::vector<DebugVtk> debug_vtk(const CaseDef& def, int threads);

} // namespace fppg
