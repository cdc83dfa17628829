/// Mesh files through Assimp: every instance of every mesh, in the scene's coordinates.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <exception>
#include <sstream>

#include <hedgerow/error.h>
#include <hedgerow/io/load_options.h>

#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

/// The most that instances may multiply a file's faces to.
constexpr std::uint64_t most_corners = std::uint64_t(1) << 33;

using Matrix = aiMatrix4x4t<double>;

Matrix in_double(const aiMatrix4x4& m) {
    return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

template <class T>
class SceneReader {
public:
    SceneReader(const aiScene& scene, const std::string& name, const Progress& progress)
        : scene_(scene), name_(name), progress_(progress) {}

    TriangleMesh<T> read() {
        struct Visit {
            const aiNode* node;
            Matrix to_scene;
        };
        std::vector<Visit> open;  // a stack of our own: files may nest nodes as deep as they like
        if (scene_.mRootNode != nullptr) open.push_back({scene_.mRootNode, Matrix()});
        while (!open.empty()) {
            const Visit v = open.back();
            open.pop_back();
            const Matrix m = v.to_scene * in_double(v.node->mTransformation);
            for (unsigned i = 0; i < v.node->mNumMeshes; ++i) add_mesh(v.node->mMeshes[i], m);
            for (unsigned i = v.node->mNumChildren; i-- > 0;) open.push_back({v.node->mChildren[i], m});
        }
        TriangleMesh<T> mesh;
        mesh.vertices = welder_.take();
        faces_.move_to(mesh);
        return mesh;
    }

private:
    void add_mesh(unsigned number, const Matrix& m) {
        if (progress_.cancelled()) throw Cancelled(name_ + ": reading was cancelled");
        if (number >= scene_.mNumMeshes || scene_.mMeshes[number] == nullptr)
            throw InputError(name_ + ": a node names mesh " + std::to_string(number) +
                             ", but there are only " + std::to_string(scene_.mNumMeshes) +
                             ". Repair the file");
        const aiMesh& part = *scene_.mMeshes[number];
        const bool mirrored = m.Determinant() < 0;  // turn what the mirror turned, so fronts stay fronts
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            add_face(part, i, m);
            if (mirrored) std::reverse(corners_.begin(), corners_.end());
            faces_.add(corners_);
        }
    }
    void add_face(const aiMesh& part, unsigned ordinal, const Matrix& m) {
        const aiFace& face = part.mFaces[ordinal];
        if ((corner_count_ += face.mNumIndices) > most_corners ||
            welder_.size() + face.mNumIndices >= most_ordinals || faces_.face_count() + 1 >= most_ordinals)
            throw InputError(name_ +
                             ": has too many faces, all instances written out. Split it into several files");
        corners_.clear();
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned v = face.mIndices[k];
            if (v >= part.mNumVertices || part.mVertices == nullptr)
                throw InputError(name_ + ": face " + std::to_string(faces_.face_count()) + " names vertex " +
                                 std::to_string(v) + ", but its mesh has only " +
                                 std::to_string(part.mNumVertices) + ". Repair the file");
            const auto& p = part.mVertices[v];
            const aiVector3t<double> q = m * aiVector3t<double>(p.x, p.y, p.z);
            corners_.push_back(welder_.vertex({rounded<T>(q.x), rounded<T>(q.y), rounded<T>(q.z)}));
        }
    }

    const aiScene& scene_;
    const std::string& name_;
    const Progress& progress_;
    std::uint64_t corner_count_ = 0;
    Welder<T> welder_;
    FaceList faces_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

template <class T>
TriangleMesh<T> read_assimp(const std::filesystem::path& path, const Progress& progress) {
    check_readable(path);
    const std::string name = path.string();
    if (progress.cancelled()) throw Cancelled(name + ": reading was cancelled");
    const std::uint64_t size = std::filesystem::file_size(path);
    progress(0, size);
    try {
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(name, aiProcess_ValidateDataStructure);
        if (scene == nullptr) {
            std::string why(trimmed(importer.GetErrorString()));
            while (why.ends_with('.')) why.pop_back();
            throw InputError(name + ": cannot be read (" + why +
                             "). Repair the file, or check its extension");
        }
        TriangleMesh<T> mesh = SceneReader<T>(*scene, name, progress).read();
        progress(size, size);
        return mesh;
    } catch (const InputError&) {
        throw;
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(name + ": cannot be read (" + error.what() +
                         "). Repair the file, or check its extension");
    }
}

std::string assimp_extensions() {
    std::string list;
    Assimp::Importer().GetExtensionList(list);  // "*.3ds;*.dae;..."
    std::erase(list, '*');
    std::replace(list.begin(), list.end(), ';', ' ');
    return list;
}

bool assimp_reads(const std::string& extension) {
    return Assimp::Importer().IsExtensionSupported(extension);
}

template TriangleMesh<float> read_assimp(const std::filesystem::path&, const Progress&);
template TriangleMesh<double> read_assimp(const std::filesystem::path&, const Progress&);

}  // namespace hedgerow::detail
