#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace fppg
{

/// Reads the legacy binary VTK files that the program writes; checks that every part ends where the
/// next one begins.
struct VtkFile
{
    std::vector<float> points;                         ///< x, y, z of each
    std::vector<double> double_points;                 ///< in their place where they are doubles
    std::map<std::string, std::vector<int>> cells;     ///< VERTICES, LINES, POLYGONS as stored
    std::map<std::string, std::vector<double>> arrays; ///< data of points or cells
    std::map<std::string, std::string> types;

    explicit VtkFile(std::string bytes) : bytes_(std::move(bytes))
    {
        if (line() != "# vtk DataFile Version 3.0") throw std::runtime_error("not VTK");
        line();
        if (line() != "BINARY" || line() != "DATASET POLYDATA")
            throw std::runtime_error("not binary polygons");
        std::size_t values = 0;
        while (at_ < bytes_.size())
        {
            std::istringstream words(line());
            std::string key;
            std::string name;
            std::string type;
            std::size_t n = 0;
            std::size_t width = 1;
            words >> key;
            if (key == "POINTS")
            {
                words >> n >> type;
                if (type == "double")
                    double_points = data(type, 3 * n);
                else
                    for (const double v : data(type, 3 * n))
                        points.push_back(static_cast<float>(v));
            }
            else if (key == "VERTICES" || key == "LINES" || key == "POLYGONS")
            {
                words >> n >> width;
                std::vector<int>& numbers = cells[key];
                for (const double v : data("int", width)) numbers.push_back(static_cast<int>(v));
            }
            else if (key == "POINT_DATA" || key == "CELL_DATA")
                words >> values;
            else if (key == "SCALARS")
            {
                words >> name >> type;
                line(); // LOOKUP_TABLE
                add(name, type, values);
            }
            else if (key == "FIELD")
            {
                std::size_t fields = 0;
                words >> name >> fields;
                for (; fields > 0; --fields)
                {
                    std::istringstream field(line());
                    field >> name >> width >> n >> type;
                    add(name, type, n * width);
                }
            }
            else
                throw std::runtime_error("unknown part '" + key + "'");
        }
    }

private:
    std::string bytes_;
    std::size_t at_ = 0;

    std::string line()
    {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string::npos) throw std::runtime_error("line without end");
        std::string text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return text;
    }
    void add(const std::string& name, const std::string& type, std::size_t n)
    {
        arrays[name] = data(type, n);
        types[name] = type;
    }
    std::vector<double> data(const std::string& type, std::size_t n)
    {
        const std::size_t size = type == "unsigned_char"    ? 1
                                 : type == "unsigned_short" ? 2
                                 : type == "double"         ? 8
                                                            : 4;
        std::vector<double> values;
        for (std::size_t i = 0; i < n; ++i)
        {
            std::uint64_t bits = 0;
            for (std::size_t b = 0; b < size; ++b)
                bits = bits << 8U | static_cast<unsigned char>(bytes_.at(at_++));
            values.push_back(type == "double" ? std::bit_cast<double>(bits)
                             : type == "float"
                                 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                             : type == "int" ? static_cast<std::int32_t>(bits)
                                             : static_cast<double>(bits));
        }
        if (bytes_.at(at_++) != '\n') throw std::runtime_error("data without line end");
        return values;
    }
};

} // namespace fppg
