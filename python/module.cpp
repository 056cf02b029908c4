// The library for Python. python/fppg/__init__.py has the documentation and the types; here arrays
// are handed out as views of the memory that C++ holds. The interpreter's lock is free while it
// works.

#include "fppg/fppg.h"

#include "app/inspect.h"
#include "app/threads.h"
#include "convert/columns.h"

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <optional>

namespace fppg
{

namespace
{

namespace py = pybind11;

using Progress = std::function<void(const std::string&, double)>;

/// Lets Ctrl-C and a caller's function end the work; from the thread that holds no lock.
Progress checked(const Progress& progress)
{
    return [progress](const std::string& stage, double share)
    {
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (progress) progress(stage, share);
    };
}

/// A read-only numpy array of memory that `owner` keeps: n numbers, or n rows of `width`.
template <typename T>
py::array view_of(const T* data, std::size_t n, std::size_t width, const py::object& owner)
{
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(n)};
    if (width > 1) shape.push_back(static_cast<py::ssize_t>(width));
    py::array_t<T> array(shape, data, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

/// The same of a vector, which the array keeps alive.
template <typename T>
py::array array_of_vector(std::vector<T> values, std::size_t width = 1)
{
    auto* kept = new std::vector<T>(std::move(values));
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
    return view_of(kept->data(), kept->size() / width, width, owner);
}

py::array array_of_places(std::vector<Vec3> places)
{
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    auto* kept = new std::vector<Vec3>(std::move(places));
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<Vec3>*>(p); });
    return view_of(reinterpret_cast<const double*>(kept->data()), kept->size(), 3, owner);
}

/// Particles of a case that was made, or of a file. Each array is made when it is first asked for,
/// in the memory that numpy then sees.
class PyParticles
{
public:
    explicit PyParticles(GeneratedCase made)
        : made_(std::make_unique<GeneratedCase>(std::move(made))),
          feed_(feed_of_case(made_->def(), made_->particles(), made_->constants()))
    {
    }
    explicit PyParticles(ParticleFeed feed) : feed_(std::move(feed)) {}

    const ParticleFeed& feed() const { return feed_; }
    std::vector<std::string> warnings() const
    {
        return made_ ? made_->warnings() : std::vector<std::string>();
    }

    /// An array by its field, of T, one or three numbers a particle.
    template <typename T>
    py::object array(Field field, ColumnType type, std::size_t width)
    {
        py::object& cached = arrays_[static_cast<std::size_t>(field)];
        if (cached) return cached;
        const std::size_t numbers = feed_.count * width;
        std::unique_ptr<T[]> values(new T[numbers]);
        {
            const py::gil_scoped_release free;
            fill_column(feed_, {"", field, type}, reinterpret_cast<char*>(values.get()),
                        default_threads());
        }
        T* const data = values.release();
        const py::capsule owner(data, [](void* p) { delete[] static_cast<T*>(p); });
        cached = view_of(static_cast<const T*>(data), feed_.count, width, owner);
        return cached;
    }

    std::vector<std::string> save(const std::string& output, const std::vector<std::string>& to)
    {
        const py::gil_scoped_release free;
        if (!made_)
            throw UsageError("a result that was loaded is saved by convert(), in another format");
        return made_->save(output, to);
    }

    std::vector<std::string> convert(const std::string& path, const std::string& format,
                                     std::vector<std::string>& losses) const
    {
        const py::gil_scoped_release free;
        ConvertedFiles written =
            convert_particles(feed_, find_particle_format(format, path), path, default_threads());
        losses = std::move(written.losses);
        std::vector<std::string> names;
        for (OutputFile& file : written.files)
        {
            names.push_back(file.path());
            file.commit();
        }
        return names;
    }

private:
    std::unique_ptr<GeneratedCase> made_;
    ParticleFeed feed_;
    std::array<py::object, 32> arrays_;
};

std::unique_ptr<PyParticles> generate(const std::string& definition, std::optional<double> dp,
                                      const std::vector<std::pair<std::string, std::string>>& vars,
                                      const std::string& fit, int threads, bool strict,
                                      const Progress& progress)
{
    GenerateOptions options;
    options.dp = dp;
    options.vars = vars;
    options.fit = fit == "on"    ? FitChoice::On
                  : fit == "raw" ? FitChoice::Raw
                  : fit == "off" ? FitChoice::Off
                                 : FitChoice::AsCase;
    options.threads = threads;
    options.strict = strict;
    options.on_progress = checked(progress);
    const py::gil_scoped_release free;
    return std::make_unique<PyParticles>(generate_case(definition, options));
}

py::dict read_facts(const std::string& definition, std::optional<double> dp,
                    const std::vector<std::pair<std::string, std::string>>& vars)
{
    CaseOptions options;
    options.dp = dp;
    options.evars = vars;
    const CaseDef def = [&]
    {
        const py::gil_scoped_release free;
        return read_case(definition, options);
    }();
    py::dict facts;
    facts["dp"] = def.grid.dp;
    facts["is_2d"] = def.grid.is_2d;
    facts["h"] = def.h;
    facts["operations"] = def.ops.size();
    facts["warnings"] = def.warnings;
    return facts;
}

py::dict fit(const py::array_t<double, py::array::c_style | py::array::forcecast>& vertices,
             const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>& triangles,
             double dp, double angle, bool is_relaxed, int threads, const Progress& progress)
{
    if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 ||
        triangles.shape(1) != 3)
        throw UsageError("fit: expected vertices and triangles as arrays of n x 3");
    TriangleSoup soup;
    for (py::ssize_t f = 0; f < triangles.shape(0); ++f)
        for (py::ssize_t corner = 0; corner < 3; ++corner)
        {
            const std::int64_t v = triangles.at(f, corner);
            if (v < 0 || v >= vertices.shape(0))
                throw UsageError("fit: triangle " + std::to_string(f) + " names the vertex " +
                                 std::to_string(v) + ", expected 0 to " +
                                 std::to_string(vertices.shape(0) - 1));
            soup.vertices.push_back({vertices.at(v, 0), vertices.at(v, 1), vertices.at(v, 2)});
        }
    FitMeshOptions options;
    options.dp = dp;
    options.feature_angle_deg = angle;
    options.is_relaxed = is_relaxed;
    options.threads = threads > 0 ? threads : default_threads();
    const Progress tell = checked(progress);
    options.on_progress = [&](int iteration) { tell("Relax", iteration / 100.0); };
    FittedMesh fitted = [&]
    {
        const py::gil_scoped_release free;
        return fit_mesh(soup, options);
    }();
    std::vector<std::uint8_t> kinds;
    for (const FitKind kind : fitted.kinds) kinds.push_back(static_cast<std::uint8_t>(kind));
    std::vector<float> normals;
    for (const std::array<float, 3>& n : fitted.normals)
        normals.insert(normals.end(), n.begin(), n.end());
    py::dict out;
    out["positions"] = array_of_places(std::move(fitted.positions));
    out["kinds"] = array_of_vector(std::move(kinds));
    out["normals"] = array_of_vector(std::move(normals), 3);
    out["area"] = fitted.area;
    out["volume"] = fitted.volume;
    out["warnings"] = fitted.warnings;
    return out;
}

std::string inspect(const std::string& path, double dp, double angle, const std::string& unit,
                    int threads)
{
    const py::gil_scoped_release free;
    InspectOptions options;
    options.path = path;
    options.dp = dp;
    options.angle_deg = angle;
    options.unit = unit;
    options.threads = threads > 0 ? threads : default_threads();
    return to_json(inspect_mesh(options));
}

std::string compare(const std::string& a, const std::string& b, int threads)
{
    const py::gil_scoped_release free;
    CompareOptions options;
    options.threads = threads > 0 ? threads : default_threads();
    return to_json(compare_results(a, b, options));
}

/// Raises the class of fppg._errors that belongs to an exception.
void raise(const std::exception& error, const char* name)
{
    const py::object type = py::module_::import("fppg._errors").attr(name);
    PyErr_SetObject(type.ptr(), type(py::str(error.what())).ptr());
}

void translate(std::exception_ptr thrown)
{
    try
    {
        if (thrown) std::rethrow_exception(std::move(thrown));
    }
    catch (const UsageError& error)
    {
        raise(error, "UsageError");
    }
    catch (const CaseError& error)
    {
        raise(error, "CaseError");
    }
    catch (const GeometryError& error)
    {
        raise(error, "GeometryError");
    }
    catch (const IoError& error)
    {
        raise(error, "IoError");
    }
    catch (const Error& error)
    {
        raise(error, "Error");
    }
}

} // namespace

} // namespace fppg

PYBIND11_MODULE(_fppg, m)
{
    using namespace fppg;
    using py::arg;
    py::register_exception_translator(translate);
    m.attr("version") = version;
    py::class_<PyParticles>(m, "Particles")
        .def_property_readonly("count", [](const PyParticles& p) { return p.feed().count; })
        .def_property_readonly("dp", [](const PyParticles& p) { return p.feed().dp; })
        .def_property_readonly("h", [](const PyParticles& p) { return p.feed().h; })
        .def_property_readonly("rhop0", [](const PyParticles& p) { return p.feed().rhop0; })
        .def_property_readonly("time", [](const PyParticles& p) { return p.feed().time; })
        .def_property_readonly("is_2d", [](const PyParticles& p) { return p.feed().is_2d; })
        .def_property_readonly("has_normals",
                               [](const PyParticles& p) { return p.feed().has_normals; })
        .def_property_readonly("has_kinds", [](const PyParticles& p) { return p.feed().has_kinds; })
        .def_property_readonly("has_volumes",
                               [](const PyParticles& p) { return p.feed().has_volumes; })
        .def_property_readonly("warnings", &PyParticles::warnings)
        .def_property_readonly(
            "bodies",
            [](const PyParticles& p)
            {
                py::list out;
                for (const FeedBody& b : p.feed().bodies)
                    out.append(py::make_tuple(b.name, b.mk, static_cast<int>(b.type)));
                return out;
            })
        .def("positions", [](PyParticles& p)
             { return p.array<double>(Field::Position, ColumnType::Float64, 3); })
        .def("velocities",
             [](PyParticles& p) { return p.array<float>(Field::Velocity, ColumnType::Float32, 3); })
        .def("normals",
             [](PyParticles& p) { return p.array<float>(Field::Normal, ColumnType::Float32, 3); })
        .def("densities",
             [](PyParticles& p) { return p.array<float>(Field::Density, ColumnType::Float32, 1); })
        .def("masses",
             [](PyParticles& p) { return p.array<double>(Field::Mass, ColumnType::Float64, 1); })
        .def("volumes",
             [](PyParticles& p) { return p.array<double>(Field::Volume, ColumnType::Float64, 1); })
        .def("ids", [](PyParticles& p)
             { return p.array<std::uint32_t>(Field::Id, ColumnType::UInt32, 1); })
        .def("mk",
             [](PyParticles& p) { return p.array<std::int32_t>(Field::Mk, ColumnType::Int32, 1); })
        .def("types", [](PyParticles& p)
             { return p.array<std::uint8_t>(Field::Type, ColumnType::UInt8, 1); })
        .def("kinds", [](PyParticles& p)
             { return p.array<std::uint8_t>(Field::Kind, ColumnType::UInt8, 1); })
        .def("save", &PyParticles::save)
        .def("convert",
             [](const PyParticles& p, const std::string& path, const std::string& format)
             {
                 std::vector<std::string> losses;
                 std::vector<std::string> files = p.convert(path, format, losses);
                 return py::make_tuple(files, losses);
             });
    m.def("read", &read_facts);
    m.def("generate", &generate);
    m.def("load",
          [](const std::string& name, const std::string& xml)
          {
              const py::gil_scoped_release free;
              return std::make_unique<PyParticles>(feed_of_file(name, xml));
          });
    m.def("fit", &fit);
    m.def("inspect", &inspect);
    m.def("compare", &compare);
    m.def("formats",
          []
          {
              py::dict out;
              for (const ParticleFormat& format : particle_formats())
                  out[format.name] = format.what;
              return out;
          });
}
