#pragma once

#include "fppg/vec.h"

#include "files/bi4_view.h"
#include "platform/file_map.h"

#include <string>
#include <vector>

namespace fppg
{

/// One output of the solver, as it lies in its mapped file.
class PartFile
{
public:
    /// throws  IoError if the file cannot be read, is not whole, holds only a piece of the
    ///         particles, or does not say its time
    explicit PartFile(const std::string& path);

    const std::string& path() const { return path_; }
    std::size_t size() const { return view_.size(); }
    std::uint32_t id(std::size_t i) const;
    /// Metres. throws  IoError if it is not finite
    Vec3 position(std::size_t i) const;

    double time() const { return time_; }
    /// A value of the output's item by its name; `otherwise` where the file has none.
    double value(std::string_view name, double otherwise) const;

private:
    std::string path_;
    FileMap file_;
    Bi4View view_;
    double time_ = 0;
};

/// The files that a call names: folders stand for the files Part_*.bi4 in them, by name.
///
/// throws  UsageError for a folder without such a file, and without any name
std::vector<std::string> part_files(const std::vector<std::string>& names);

} // namespace fppg
