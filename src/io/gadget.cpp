/// GADGET's layout through the HDF5 library.
#include "gadget.h"

#include <hedgerow/base/error.h>

#ifndef HEDGEROW_HAS_HDF5
#define HEDGEROW_HAS_HDF5 1
#endif

#if HEDGEROW_HAS_HDF5
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "byte_source.h"
#include "output_file.h"
#endif

namespace hedgerow::detail {

bool names_hdf5(const std::filesystem::path& path) {
    return path.extension() == ".hdf5" || path.extension() == ".h5";
}

#if HEDGEROW_HAS_HDF5
namespace {

/// The library keeps its state in global variables.
std::mutex one_at_a_time;

/// An object of the library, closed in the end.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    explicit operator bool() const { return id_ >= 0; }
    operator hid_t() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// While one lives the library prints no messages of its own.
class Quiet {
public:
    Quiet() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

constexpr std::size_t written_types = 6;  // of particles: gas, halo, disc, bulge, stars, boundary
constexpr std::size_t halo = 1;           // what gravity alone moves

std::string group_of(std::size_t type) {
    return "PartType" + std::to_string(type);
}

class Reader {
public:
    explicit Reader(const std::filesystem::path& path)
        : path_(path), file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
        std::error_code failed;
        bytes_ = std::filesystem::file_size(path, failed);
        if (failed) throw InputError(path.string() + ": cannot be opened: " + failed.message());
        if (!file_) fault("is no HDF5 file, or is cut short");
    }
    [[noreturn]] void fault(const std::string& what) const { throw InputError(path_.string() + ": " + what); }

    bool has(const std::string& object) const {
        for (std::size_t end = object.find('/');; end = object.find('/', end + 1)) {
            if (H5Lexists(file_, object.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
            if (end == std::string::npos) return true;
        }
    }
    /// The numbers of an attribute of the header.
    std::vector<double> attribute(const char* name) const {
        const Handle attribute(H5Aopen_by_name(file_, "Header", name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        if (!attribute) fault(std::string("its Header has no attribute ") + name);
        const Handle space(H5Aget_space(attribute), H5Sclose);
        constexpr hssize_t most = 64;
        const hssize_t count = H5Sget_simple_extent_npoints(space);
        std::vector<double> numbers(static_cast<std::size_t>(std::clamp<hssize_t>(count, 0, most)));
        if (count < 1 || count > most || !is_number(H5Aget_type(attribute)) ||
            H5Aread(attribute, H5T_NATIVE_DOUBLE, numbers.data()) < 0)
            fault(std::string("attribute ") + name + " of its Header is no list of numbers");
        return numbers;
    }
    /// The numbers of an attribute that has one for each type of particles.
    std::vector<double> attribute_of_types(const char* name, std::size_t types) const {
        std::vector<double> numbers = attribute(name);
        if (numbers.size() != types)
            fault(std::string("attribute ") + name + " of its Header is not " + std::to_string(types) +
                  " numbers");
        return numbers;
    }
    double number(const char* name) const { return attribute_of_types(name, 1)[0]; }
    /// The rows of a dataset, each of so many columns.
    std::vector<double> rows(const std::string& name, std::size_t columns) const {
        const Handle data(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
        if (!data) fault("there is no dataset " + name);
        const Handle space(H5Dget_space(data), H5Sclose);
        std::array<hsize_t, 2> size{0, 1};
        const int dimensions = H5Sget_simple_extent_ndims(space);
        if (dimensions < 1 || dimensions > 2 || !is_number(H5Dget_type(data)))
            fault("dataset " + name + " is no table of numbers");
        H5Sget_simple_extent_dims(space, size.data(), nullptr);
        if (size[1] != columns)
            fault("dataset " + name + " has " + std::to_string(size[1]) + " columns, not " +
                  std::to_string(columns));
        // What is compressed is at most a thousandth of what it holds.
        if (size[0] / 1024 * columns > bytes_)
            fault("dataset " + name + " claims " + std::to_string(size[0]) +
                  " rows, more than the file holds");
        std::vector<double> numbers(size[0] * columns);
        if (!numbers.empty() &&
            H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
            fault("dataset " + name + " cannot be read");
        return numbers;
    }
    std::vector<Vec3d> vectors(const std::string& name, std::size_t count) const {
        const std::vector<double> numbers = rows(name, 3);
        expect(name, numbers.size() / 3, count);
        std::vector<Vec3d> all(count);
        for (std::size_t i = 0; i < count; ++i)
            all[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
        return all;
    }
    std::vector<double> scalars(const std::string& name, std::size_t count) const {
        std::vector<double> numbers = rows(name, 1);
        expect(name, numbers.size(), count);
        return numbers;
    }

private:
    void expect(const std::string& name, std::size_t rows, std::size_t count) const {
        if (rows != count)
            fault("dataset " + name + " has " + std::to_string(rows) + " rows for " + std::to_string(count) +
                  " particles");
    }
    static bool is_number(hid_t of) {
        const Handle type(of, H5Tclose);
        const H5T_class_t kind = H5Tget_class(type);
        return kind == H5T_INTEGER || kind == H5T_FLOAT;
    }

    std::filesystem::path path_;
    Handle file_;
    std::uintmax_t bytes_ = 0;
};

template <class T>
void append(std::vector<T>& all, std::vector<T> more) {
    all.insert(all.end(), more.begin(), more.end());
}

/// Writes to a file that the library keeps in memory.
class Writer {
public:
    explicit Writer(const std::filesystem::path& path)
        : path_(path), access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), file_(create(access_), H5Fclose) {
        if (!file_) fault();
    }
    template <class T>
    void attribute(hid_t of, const char* name, const std::vector<T>& numbers) const {
        const hsize_t count = numbers.size();
        const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                           H5Sclose);
        const Handle made(H5Acreate2(of, name, stored<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        if (!made || H5Awrite(made, native<T>(), numbers.data()) < 0) fault();
    }
    template <class T>
    void dataset(hid_t group, const char* name, const T* numbers, std::size_t rows,
                 std::size_t columns) const {
        const std::array<hsize_t, 2> size{rows, columns};
        const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr), H5Sclose);
        const Handle made(H5Dcreate2(group, name, stored<T>(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                          H5Dclose);
        if (!made || (rows > 0 && H5Dwrite(made, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0))
            fault();
    }
    Handle group(const std::string& name) const {
        Handle made(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        if (!made) fault();
        return made;
    }
    void finish() const {
        H5Fflush(file_, H5F_SCOPE_LOCAL);
        const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
        if (size < 0) fault();
        std::string image(static_cast<std::size_t>(size), '\0');
        if (H5Fget_file_image(file_, image.data(), image.size()) < 0) fault();
        OutputFile out(path_);
        out.write(image);
        out.commit();
    }

private:
    [[noreturn]] void fault() const {
        throw OutputError(path_.string() + ": the HDF5 library cannot write it");
    }
    static hid_t create(hid_t access) {
        constexpr std::size_t grow_by = std::size_t{1} << 24;
        H5Pset_fapl_core(access, grow_by, false);
        return H5Fcreate("snapshot", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    }
    template <class T>
    static hid_t native() {
        if constexpr (std::same_as<T, double>) return H5T_NATIVE_DOUBLE;
        return sizeof(T) == 8 ? H5T_NATIVE_UINT64 : H5T_NATIVE_INT32;
    }
    template <class T>
    static hid_t stored() {
        if constexpr (std::same_as<T, double>) return H5T_IEEE_F64LE;
        return sizeof(T) == 8 ? H5T_STD_U64LE : H5T_STD_I32LE;
    }

    std::filesystem::path path_;
    Handle access_, file_;
};

}  // namespace

namespace {

/// The files of a snapshot: NAME.0.hdf5 to NAME.N.hdf5, if `path` is one of these.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path, const Reader& first) {
    const double count = first.number("NumFilesPerSnapshot");
    if (!(count > 1)) return {path};
    constexpr double most = 65536;
    const std::filesystem::path stem = path.stem();
    const std::string number = stem.extension().string();
    if (!(count <= most) || number.size() < 2 ||
        !std::all_of(number.begin() + 1, number.end(), [](char c) { return c >= '0' && c <= '9'; }))
        first.fault("is one of several files of a snapshot, which are found if they are called NAME.0" +
                    path.extension().string() + ", NAME.1" + path.extension().string() + ", and so on");
    std::vector<std::filesystem::path> files;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        files.push_back(path.parent_path() /
                        (stem.stem().string() + "." + std::to_string(i) + path.extension().string()));
    return files;
}

/// The masses of so many particles of a type: a number each, or one for all in the header.
std::vector<double> masses_of(const Reader& file, std::size_t type, std::size_t count) {
    const std::string group = group_of(type) + "/";
    for (const char* const name : {"Masses", "DynamicalMasses"})  // the latter of black holes (SWIFT)
        if (file.has(group + name)) return file.scalars(group + name, count);
    const std::vector<double> of_type = file.attribute("MassTable");
    if (type >= of_type.size() || !(of_type[type] > 0))
        file.fault("the particles of " + group_of(type) + " have no masses: there is no dataset " + group +
                   "Masses, and MassTable has none for them. Write either");
    return std::vector<double>(count, of_type[type]);
}

/// Adds the particles of a type to those of a state. Returns whether it has their forces.
bool add_type(const Reader& file, std::size_t type, MotionState& state) {
    const auto counts = file.attribute("NumPart_ThisFile");
    if (type >= counts.size() || !(counts[type] > 0)) return true;
    if (!(counts[type] < 0x1p40)) file.fault("claims too many particles");
    const std::size_t count = static_cast<std::size_t>(counts[type]);
    const std::string group = group_of(type) + "/";
    Particles& all = state.particles;
    append(all.places, file.vectors(group + "Coordinates", count));
    append(all.velocities, file.vectors(group + "Velocities", count));
    append(all.masses, masses_of(file, type, count));
    if (!file.has(group + "Potential") || !file.has(group + "Acceleration")) return false;
    append(state.potentials, file.scalars(group + "Potential", count));
    append(state.accelerations, file.vectors(group + "Acceleration", count));
    return true;
}

}  // namespace

MotionState load_gadget(const std::filesystem::path& path) {
    check_readable(path);
    const std::lock_guard lock(one_at_a_time);
    const Quiet quiet;
    const Reader first(path);
    if (!first.has("Header")) first.fault("has no group Header: it is no snapshot in GADGET's layout");
    const std::size_t types = first.attribute("NumPart_ThisFile").size();
    MotionState state;
    state.time = first.number("Time");
    const auto files = files_of(path, first);
    bool known = true;
    for (std::size_t type = 0; type < types; ++type)
        for (const auto& file : files) {
            check_readable(file);
            known = add_type(Reader(file), type, state) && known;
        }
    if (!known) state.potentials.clear(), state.accelerations.clear();
    return state;
}

void save_gadget(const std::filesystem::path& path, const MotionState& state, double period) {
    const std::lock_guard lock(one_at_a_time);
    const Quiet quiet;
    const Particles& all = state.particles;
    const Writer file(path);
    const Handle header = file.group("Header");
    using Counts = std::vector<std::int32_t>;
    const std::uint64_t n = all.size();
    if (n > std::numeric_limits<std::int32_t>::max())
        throw OutputError(path.string() + ": " + std::to_string(n) + " particles are more than a file holds");
    Counts counts(written_types);
    counts[halo] = static_cast<std::int32_t>(n);
    file.attribute(header, "NumPart_ThisFile", counts);
    file.attribute(header, "NumPart_Total", counts);
    file.attribute(header, "NumPart_Total_HighWord", Counts(written_types));
    file.attribute(header, "MassTable", std::vector<double>(written_types));
    const std::pair<const char*, double> numbers[] = {{"Time", state.time}, {"Redshift", 0},
                                                      {"BoxSize", period},  {"Omega0", 0},
                                                      {"OmegaLambda", 0},   {"HubbleParam", 1}};
    for (const auto& [name, number] : numbers) file.attribute(header, name, std::vector{number});
    const std::pair<const char*, std::int32_t> flags[] = {
        {"NumFilesPerSnapshot", 1}, {"Flag_Sfr", 0},      {"Flag_Cooling", 0},        {"Flag_StellarAge", 0},
        {"Flag_Metals", 0},         {"Flag_Feedback", 0}, {"Flag_DoublePrecision", 1}};
    for (const auto& [name, flag] : flags) file.attribute(header, name, Counts{flag});
    const Handle group = file.group(group_of(halo));
    const auto vectors = [&](const char* name, const std::vector<Vec3d>& of) {
        static_assert(sizeof(Vec3d) == 3 * sizeof(double));
        file.dataset(group, name, of.empty() ? nullptr : of[0].data, of.size(), 3);
    };
    vectors("Coordinates", all.places), vectors("Velocities", all.velocities);
    std::vector<std::uint64_t> ids(n);
    for (std::uint64_t i = 0; i < n; ++i) ids[i] = i + 1;
    file.dataset(group, "ParticleIDs", ids.data(), n, 1);
    file.dataset(group, "Masses", all.masses.data(), n, 1);
    file.dataset(group, "Potential", state.potentials.data(), state.potentials.size(), 1);
    vectors("Acceleration", state.accelerations);
    file.finish();
}
#else
namespace {
[[noreturn]] void refuse(const std::filesystem::path& path) {
    throw UsageError(path.string() +
                     ": this build has no HDF5: build with HEDGEROW_HDF5=ON, or use .npy or .csv");
}
}  // namespace

MotionState load_gadget(const std::filesystem::path& path) {
    refuse(path);
}
void save_gadget(const std::filesystem::path& path, const MotionState&, double) {
    refuse(path);
}
#endif

}  // namespace hedgerow::detail
