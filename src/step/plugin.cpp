// The plugin that reads STEP files by OpenCASCADE. It is a library of its own, opened where a STEP
// file is read: linked into the program, OpenCASCADE's 60 libraries would make every start 50 ms
// longer.
#include "step/step_file.h"

#include <GeomAdaptor_Surface.hxx>
#include <Standard_Failure.hxx>

#include <algorithm>
#include <limits>
#include <memory>

struct FppgStepFile
{
    fppg::step::File file;
};

namespace fppg::step
{
namespace
{

std::string& fault_text()
{
    static std::string text;
    return text;
}

/// Runs what may fail in OpenCASCADE, and returns what is wrong.
template <typename Run>
const char* guarded(const Run& run)
{
    std::string& fault = fault_text();
    fault.clear();
    try
    {
        run(fault);
    }
    catch (const Standard_Failure& failure)
    {
        fault = std::string("OpenCASCADE: ") + failure.GetMessageString();
    }
    return fault.c_str();
}

FppgStepFile* open_file(const char* path, const char** fault)
{
    auto out = std::make_unique<FppgStepFile>();
    *fault = guarded([&](std::string& wrong) { wrong = read_file(path, out->file); });
    return **fault == '\0' ? out.release() : nullptr;
}

void close_file(FppgStepFile* file)
{
    delete file;
}

std::size_t part_count(const FppgStepFile* file)
{
    return file->file.parts.size();
}

void part_of(const FppgStepFile* file, std::size_t index, FppgStepPart* out)
{
    const Part& part = file->file.parts[index];
    *out = {part.name.c_str(),
            part.path.c_str(),
            part.has_color ? 1 : 0,
            {part.color[0], part.color[1], part.color[2]}};
}

const char* mesh_of(FppgStepFile* file, std::size_t index, double deflection, double angle,
                    void* to, void (*take)(void* to, const FppgStepMesh* mesh))
{
    return guarded([&](std::string&)
                   { mesh_part(file->file, index, deflection, angle, to, take); });
}

void put(const gp_XYZ& v, double* to)
{
    to[0] = v.X();
    to[1] = v.Y();
    to[2] = v.Z();
}

void surface_at(const FppgStepFile* file, std::uint32_t face, double u, double v, double out[18])
{
    gp_Pnt s;
    gp_Vec su, sv, suu, svv, suv;
    try
    {
        file->file.faces[face]->D2(u, v, s, su, sv, suu, svv, suv);
    }
    catch (const Standard_Failure&)
    {
        std::fill_n(out, 18, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    put(s.XYZ(), out);
    put(su.XYZ(), out + 3);
    put(sv.XYZ(), out + 6);
    put(suu.XYZ(), out + 9);
    put(suv.XYZ(), out + 12);
    put(svv.XYZ(), out + 15);
}

int is_plane(const FppgStepFile* file, std::uint32_t face)
{
    return GeomAdaptor_Surface(file->file.faces[face]).GetType() == GeomAbs_Plane ? 1 : 0;
}

} // namespace
} // namespace fppg::step

extern "C" __attribute__((visibility("default"))) const FppgStep* fppg_step_of_version_2()
{
    using namespace fppg::step;
    static const FppgStep functions{open_file, close_file, part_count, part_of,
                                    mesh_of,   surface_at, is_plane};
    return &functions;
}
