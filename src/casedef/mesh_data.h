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
    /// Per time one number a node, or three.
    std::vector<std::vector<double>> values;
};

/// Reads GenCase's text form of mesh data ("JMeshTDatas"): a line of names; a line with format,
/// name, units, type (float or float3), Data12, three counts of nodes, the first node, three steps,
/// a direction that is not used; a line of names; then a line a time. Separated by semicolons or
/// commas.
///
/// throws  IoError if the file cannot be opened; CaseError with file and line if it is wrong
MeshData read_mesh_data(const std::string& path);

/// The numbers of all nodes at a time, linear between two times, those of the first or last one
/// before or after them.
std::vector<double> values_at_time(const MeshData& data, double time);

} // namespace fppg
