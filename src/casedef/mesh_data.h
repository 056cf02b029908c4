#pragma once

#include "fppg/initials.h"

#include <string>
#include <vector>

namespace fppg
{

/// A file of values on a mesh at several times.
struct MeshData
{
    MeshValues mesh; ///< without values
    bool is_vector = false;
    std::vector<double> times; ///< seconds, ascending
    /// Per time one number per node, or three.
    std::vector<std::vector<double>> values;
};

/// Reads GenCase's mesh data "JMeshTDatas", version 200817.
///
/// Text (.csv): a line of names; a line with format, name, units, type (float or float3), Data12,
/// three counts of nodes, the first node, three steps, a direction that is not used; a line of
/// names; then one line per time. Separated by semicolons or commas. Whatever its name, its data
/// are taken, as GenCase v5.4.354 does.
/// Binary (.mbi4): one item that describes the mesh and the data, then one per time. The data are
/// found by name, upper and lower case alike.
/// Data of two dimensions (Data12, DataTag 12) have one node along the third axis.
///
/// name    of the data in a binary file: Rhop, Vel (three numbers per node) or VelDir (one)
/// throws  IoError if the file cannot be opened or ends too early; CaseError with the file, and in
///         texts the line, if it is wrong
MeshData read_mesh_data(const std::string& path, const std::string& name);

/// The numbers of all nodes at a time, linear between two times, those of the first or last one
/// before or after them.
std::vector<double> values_at_time(const MeshData& data, double time);

} // namespace fppg
