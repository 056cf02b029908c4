// The plugin libfppg_hdf5.so: all that calls the HDF5 library.
//
// Datasets are contiguous, allocated when they are made and never filled, so that their places are
// known and nothing is written twice. Times are left out: the same input gives the same bytes.

#include "convert/hdf5_file.h"

#include <hdf5.h>

#include <stdexcept>

namespace fppg
{

namespace
{

/// The innermost message of the library, which names the cause.
herr_t keep_message(unsigned, const H5E_error2_t* error, void* out)
{
    *static_cast<std::string*>(out) = std::string(": ") + error->desc;
    return 1;
}

/// Throws what failed with the library's reason, which the next call of the library forgets.
void require(bool success, const std::string& what)
{
    if (success) return;
    std::string cause;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_message, &cause);
    throw std::runtime_error(what + cause);
}

/// An identifier of the library, closed at the end of its scope.
struct Hdf5Id
{
    Hdf5Id(hid_t given, herr_t (*closing)(hid_t), const std::string& what)
        : id(given), close(closing)
    {
        require(id >= 0, what);
    }
    Hdf5Id(const Hdf5Id&) = delete;
    Hdf5Id& operator=(const Hdf5Id&) = delete;
    ~Hdf5Id() { close(id); }
    operator hid_t() const { return id; }

    hid_t id;
    herr_t (*close)(hid_t);
};

hid_t type_of(ColumnType type)
{
    switch (type)
    {
        case ColumnType::UInt8:
            return H5T_STD_U8LE;
        case ColumnType::Int32:
            return H5T_STD_I32LE;
        case ColumnType::UInt32:
            return H5T_STD_U32LE;
        case ColumnType::Int64:
            return H5T_STD_I64LE;
        case ColumnType::Float32:
            return H5T_IEEE_F32LE;
        case ColumnType::Float64:
            break;
    }
    return H5T_IEEE_F64LE;
}

void add_attribute(hid_t object, const Hdf5Attribute& attribute)
{
    const std::string what = "attribute " + attribute.name;
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Hdf5Id text(H5Tcopy(H5T_C_S1), H5Tclose, what);
    hid_t type = H5T_STD_I64LE;
    const void* value = std::get_if<std::int64_t>(&attribute.value);
    if (const auto* real = std::get_if<double>(&attribute.value))
    {
        type = H5T_IEEE_F64LE;
        value = real;
    }
    else if (const auto* words = std::get_if<std::string>(&attribute.value))
    {
        H5Tset_size(text, words->size() + 1);
        type = text;
        value = words->c_str();
    }
    const Hdf5Id made(
        H5Acreate2(object, attribute.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
        what);
    require(H5Awrite(made, type, value) >= 0, what);
}

void add_group(hid_t file, const Hdf5Object& object)
{
    const Hdf5Id group(object.path.empty() ? H5Gopen2(file, "/", H5P_DEFAULT)
                                           : H5Gcreate2(file, object.path.c_str(), H5P_DEFAULT,
                                                        H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose, "group " + object.path);
    for (const Hdf5Attribute& attribute : object.attributes) add_attribute(group, attribute);
}

void add_dataset(hid_t file, Hdf5Object& object)
{
    const std::string what = "dataset " + object.path;
    const hsize_t sizes[] = {object.count, 3};
    const Hdf5Id space(H5Screate_simple(object.column.is_vector() ? 2 : 1, sizes, nullptr),
                       H5Sclose, what);
    const Hdf5Id settings(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
    H5Pset_layout(settings, H5D_CONTIGUOUS);
    H5Pset_alloc_time(settings, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(settings, H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(settings, false);
    const Hdf5Id dataset(H5Dcreate2(file, object.path.c_str(), type_of(object.column.type), space,
                                    H5P_DEFAULT, settings, H5P_DEFAULT),
                         H5Dclose, what);
    for (const Hdf5Attribute& attribute : object.attributes) add_attribute(dataset, attribute);
    if (object.count == 0) return;
    object.at = H5Dget_offset(dataset);
    require(object.at != HADDR_UNDEF, what);
}

} // namespace

/// LayOutHdf5
extern "C" __attribute__((visibility("default"))) std::string fppg_lay_out_hdf5(
    const std::string& path, std::vector<Hdf5Object>& objects)
{
    try
    {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "settings");
        // OutputFile holds the lock.
        H5Pset_file_locking(access, false, true);
        const Hdf5Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                          "the file");
        for (Hdf5Object& object : objects)
            if (object.is_dataset)
                add_dataset(file, object);
            else
                add_group(file, object);
        require(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "the file");
        return {};
    }
    catch (const std::exception& error)
    {
        return error.what();
    }
}

} // namespace fppg
