/// Chooses the reader and the writer of points by the extension.
#include <hedgerow/io/point_file.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/validate.h>

#include "load_report.h"
#include "memory.h"
#include "mesh_parts.h"
#include "npy_format.h"
#include "output_file.h"
#include "readers.h"
#include "text.h"

namespace hedgerow {

namespace detail {

/// Points alone of a mesh, whatever connects them. Throws InputError if they do not lie in the plane that is
/// asked for.
template <int D, class T>
PointCloud<T, D> vertices_of(const ByteSource& file, TriangleMesh<T> mesh) {
    if constexpr (D == 3) {
        return {std::move(mesh.vertices)};
    } else {
        PointCloud<T, D> cloud;
        for (const Vec<T, 3>& p : mesh.vertices) {
            if (p[2] != 0) file.fail("z is not 0, but the points are read in 2D. Read them in 3D");
            append(file, cloud.points, Vec<T, D>(p[0], p[1]));
        }
        return cloud;
    }
}

template <class T, int D>
PointCloud<T, D> read_npy_points(ByteSource& file) {
    const NpyArray array = read_npy(file);
    if (array.shape.size() != 2 || array.shape[1] != D) {
        std::string shape;
        for (const std::size_t n : array.shape) shape += (shape.empty() ? "" : ", ") + std::to_string(n);
        file.fail("the array has shape (" + shape + "), but points in " + std::to_string(D) + "D are (N, " +
                  std::to_string(D) + "). Reshape it, or load it with another dimension");
    }
    expect_memory(file.name(), "its " + std::to_string(array.size()) + " numbers",
                  2 * array.size() * sizeof(double));
    PointCloud<T, D> cloud;
    cloud.points.resize(array.shape[0]);
    const std::vector<double> values = array.as<double>();
    for (std::size_t i = 0; i < values.size(); ++i)
        cloud.points[i / D][static_cast<int>(i % D)] = coordinate<T>(values[i], file.rounding());
    return cloud;
}

namespace {

[[noreturn]] void fail_unknown_points(const std::filesystem::path& path, const char* known) {
    throw InputError(path.string() + ": the extension " + shown(path.extension().string()) +
                     " is not known for points. Known are " + known);
}

template <class T, int D>
void write_ply_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    const std::string type = std::is_same_v<T, float> ? "float" : "double";
    std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    header += std::to_string(cloud.size()) + "\n";
    for (const char axis : {'x', 'y', 'z'}) header += "property " + type + " " + axis + "\n";
    file.write(header + "end_header\n");
    for (const Vec<T, D>& p : cloud.points) {
        for (int i = 0; i < 3; ++i) file.little(i < D ? p[i] : T(0));
        file.advance();
    }
}

template <class T, int D>
void write_npy_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    file.write(npy_header(npy_dtype<T>(), {cloud.size(), D}));
    for (const Vec<T, D>& p : cloud.points) {
        for (int i = 0; i < D; ++i) file.little(p[i]);
        file.advance();
    }
}

template <class T, int D>
void write_lines(OutputFile& file, const PointCloud<T, D>& cloud, char separator) {
    std::string line;
    for (const Vec<T, D>& p : cloud.points) {
        line.clear();
        for (int i = 0; i < D; ++i) {
            if (i > 0) line += separator;
            append_number(line, p[i]);
        }
        file.write(line += '\n');
        file.advance();
    }
}

template <class T, int D>
void write_csv_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    file.write(D == 2 ? "x,y\n" : "x,y,z\n");
    write_lines(file, cloud, ',');
}

template <class T, int D>
void write_xyz_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    write_lines(file, cloud, ' ');
}

}  // namespace
}  // namespace detail

template <class T, int D>
PointCloud<T, D> load_points(const std::filesystem::path& path, const LoadOptions& options,
                             const Progress& progress) {
    const std::string format = detail::format_of(path);
    PointCloud<T, D> (*read)(detail::ByteSource&) = nullptr;
    if (format == ".ply") read = detail::read_ply_points<T, D>;
    if (format == ".npy") read = detail::read_npy_points<T, D>;
    if (format == ".csv") read = detail::read_csv_points<T, D>;
    if (format == ".xyz") read = detail::read_xyz_points<T, D>;
    if (format == ".obj")
        read = [](auto& file) { return detail::vertices_of<D>(file, detail::read_obj<T>(file)); };
    if (format == ".off")
        read = [](auto& file) { return detail::vertices_of<D>(file, detail::read_off<T>(file)); };
    const bool is_gltf = format == ".gltf" || format == ".glb";
    if (read == nullptr && !is_gltf) {
        detail::check_readable(path);
        detail::fail_unknown_points(path, ".ply .npy .csv .xyz .obj .off .gltf .glb, each also with .gz");
    }
    return detail::within_memory(path, [&] {
        detail::ByteSource file(path, progress);
        PointCloud<T, D> cloud = validated(
            is_gltf ? detail::vertices_of<D>(file, detail::read_gltf_points<T>(file, path)) : read(file),
            path.string(), options);
        detail::report_on(file, cloud.points, options);
        return cloud;
    });
}

template <class T, int D>
void save_points(const std::filesystem::path& path, const PointCloud<T, D>& cloud, const Progress& progress) {
    const std::string extension = detail::lower_case(path.extension().string());
    void (*write)(detail::OutputFile&, const PointCloud<T, D>&) = nullptr;
    if (extension == ".ply") write = detail::write_ply_points;
    if (extension == ".npy") write = detail::write_npy_points;
    if (extension == ".csv") write = detail::write_csv_points;
    if (extension == ".xyz") write = detail::write_xyz_points;
    if (write == nullptr) detail::fail_unknown_points(path, ".ply .npy .csv .xyz");
    detail::OutputFile file(path, progress);
    file.expect(cloud.size());
    write(file, cloud);
    file.commit();
}

using Path = std::filesystem::path;
template PointCloud<float, 2> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<float, 3> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<double, 2> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<double, 3> load_points(const Path&, const LoadOptions&, const Progress&);
template void save_points(const Path&, const PointCloud<float, 2>&, const Progress&);
template void save_points(const Path&, const PointCloud<float, 3>&, const Progress&);
template void save_points(const Path&, const PointCloud<double, 2>&, const Progress&);
template void save_points(const Path&, const PointCloud<double, 3>&, const Progress&);

}  // namespace hedgerow
