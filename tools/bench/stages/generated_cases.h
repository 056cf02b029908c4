#pragma once

#include <cstddef>
#include <string>

/// A folder that is removed at the end.
class WorkFolder
{
public:
    WorkFolder();
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    std::string file(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

/// Writes a sphere of radius 0.4 about (0.5, 0.5, 0.5) as STL with 4 * rings * (rings - 1) facets.
void write_sphere_stl(const std::string& path, std::size_t rings, bool is_binary);

/// Facets of a sphere of so many rings.
inline std::size_t sphere_facets(std::size_t rings)
{
    return 4 * rings * (rings - 1);
}

/// Writes the definition of a case in the domain from 0 to 1 (nodes along each axis: about 1 / dp)
/// with these commands in its main list.
void write_definition(const std::string& path, double dp, const std::string& commands);
