/// glTF 2.0 scenes with their looks: an object a mesh, an instance a node.
#include <array>
#include <map>
#include <optional>
#include <utility>

#include <hedgerow/base/error.h>

#include "corner_values.h"
#include "gltf_file.h"
#include "gltf_lights.h"
#include "gltf_materials.h"
#include "gltf_meshes.h"
#include "gltf_nodes.h"
#include "mesh_parts.h"
#include "model_readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

using Json = GltfFile::Json;

Vec2f value_of(const GltfAccessor& from, std::uint64_t i, Vec2f*) {
    return Vec2f(rounded<float>(from.value(i, 0)), rounded<float>(from.value(i, 1)));
}
Vec3f value_of(const GltfAccessor& from, std::uint64_t i, Vec3f*) {
    return Vec3f(from.point(i));
}
Rgba value_of(const GltfAccessor& from, std::uint64_t i, Rgba*) {
    return {Vec3f(from.point(i)), from.components() == 4 ? rounded<float>(from.value(i, 3)) : 1};
}

/// Values at the corners of an object's triangles, of which some parts may have none.
template <class V>
class CornerBuilder {
public:
    explicit CornerBuilder(const ByteSource& file) : file_(file), welder_(file) {}

    /// Adds the values of the corners of triangle `triangle`.
    void add(std::size_t triangle, const GltfAccessor& from, const std::array<std::uint64_t, 3>& named) {
        fill_up(triangle);
        check_room(file_, welder_.size() + 3, "normals, texture coordinates or colours");
        TriangleIndices corners{};
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = welder_.vertex(value_of(from, named[k], static_cast<V*>(nullptr)));
        append(file_, corners_, corners);
    }
    bool empty() const { return corners_.empty(); }
    CornerValues<V> take(std::size_t triangles) {
        if (!empty()) fill_up(triangles);
        return {welder_.take(), std::move(corners_)};
    }

private:
    void fill_up(std::size_t triangles) {
        while (corners_.size() < triangles)
            append(file_, corners_, TriangleIndices{no_value, no_value, no_value});
    }

    const ByteSource& file_;
    ValueWelder<V, float> welder_;
    std::vector<TriangleIndices> corners_;
};

/// Makes an object of the parts of a mesh.
template <class T>
class ObjectBuilder {
public:
    ObjectBuilder(const ModelContext& context, GltfFile& file, GltfMeshes& meshes)
        : context_(context), file_(file), meshes_(meshes) {}

    /// Adds a part, whose triangles have the material `material`.
    void add(const GltfPart& part, std::uint32_t material) {
        const Json& attributes = (*part.primitive)["attributes"];
        const GltfAccessor* const normals = accessor(attributes, "NORMAL", part);
        const GltfAccessor* const colours = accessor(attributes, "COLOR_0", part);
        std::vector<const GltfAccessor*> places;
        for (std::size_t k = 0; k < most_sets; ++k)
            places.push_back(accessor(attributes, ("TEXCOORD_" + std::to_string(k)).c_str(), part));
        tell_unused(attributes);
        for (std::uint64_t i = 0; i < part.triangles; ++i) {
            if (i % 65536 == 0) file_.expect_not_cancelled();
            const auto named = part.corners(i);
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex(part, named[k]);
            const std::size_t ordinal = faces_.triangle_count();
            if (normals != nullptr) normals_.add(ordinal, *normals, named);
            if (colours != nullptr) colours_.add(ordinal, *colours, named);
            for (std::size_t k = 0; k < most_sets; ++k)
                if (places[k] != nullptr) set(k).add(ordinal, *places[k], named);
            faces_.add(triangle);
        }
        parts_.push_back({faces_.triangle_count(), material});
    }
    Object<T> take(const std::string& name) {
        Object<T> object;
        object.name = name;
        object.mesh.vertices = welder_.take();
        faces_.move_to(object.mesh);
        const std::size_t triangles = object.mesh.size();
        object.attributes.normals = normals_.take(triangles);
        object.attributes.colours = colours_.take(triangles);
        for (auto& s : sets_) object.attributes.texture_coordinates.push_back(s.take(triangles));
        check_attributes(context_.file, object.mesh, object.attributes, context_.warnings);
        take_materials(object);
        return object;
    }

private:
    static constexpr std::size_t most_sets = 4;

    struct PartEnd {
        std::size_t end;  // of its triangles
        std::uint32_t material;
    };

    /// The accessor of an attribute; null if there is none.
    const GltfAccessor* accessor(const Json& attributes, const char* name, const GltfPart& part) {
        const auto number = file_.number(attributes, name);
        if (!number) return nullptr;
        const std::string_view kind(name);
        int components = kind.starts_with("TEXCOORD") ? 2 : 3;
        if (kind == "COLOR_0" && file_.text(file_.object("accessors", *number), "type") == "VEC4")
            components = 4;
        const GltfAccessor& found = meshes_.accessor(*number, components);
        if (found.size() != part.positions->size())
            file_.fail(std::string(name) + " has " + std::to_string(found.size()) + " values for " +
                       std::to_string(part.positions->size()) + " positions");
        return &found;
    }
    void tell_unused(const Json& attributes) const {
        for (const auto& [name, value] : attributes.items()) {
            const bool is_set = name.size() == 10 && name.starts_with("TEXCOORD_") && name[9] >= '0' &&
                                name[9] < '0' + static_cast<int>(most_sets);
            if (name != "POSITION" && name != "NORMAL" && name != "COLOR_0" && !is_set)
                context_.not_shown.add("attribute " + shown(name) + " (glTF)");
        }
    }
    std::uint32_t vertex(const GltfPart& part, std::uint64_t named) {
        if (named >= part.positions->size()) meshes_.fail_corner(faces_.face_count(), named, part);
        check_room(context_.file, welder_.size(), "vertices");
        const Vec3d p = part.positions->point(named);
        return welder_.vertex({rounded<T>(p[0]), rounded<T>(p[1]), rounded<T>(p[2])});
    }
    CornerBuilder<Vec2f>& set(std::size_t k) {
        while (sets_.size() <= k) sets_.emplace_back(context_.file);
        return sets_[k];
    }
    void take_materials(Object<T>& object) const {
        object.material = parts_.empty() ? 0 : parts_[0].material;
        const bool is_one = std::all_of(parts_.begin(), parts_.end(),
                                        [&](const PartEnd& p) { return p.material == object.material; });
        if (is_one) return;
        for (const PartEnd& p : parts_)
            while (object.materials.size() < p.end) append(context_.file, object.materials, p.material);
    }

    ModelContext context_;
    GltfFile& file_;
    GltfMeshes& meshes_;
    Welder<T> welder_{context_.file};
    FaceList faces_{context_.file};
    CornerBuilder<Vec3f> normals_{context_.file};
    CornerBuilder<Rgba> colours_{context_.file};
    std::vector<CornerBuilder<Vec2f>> sets_;
    std::vector<PartEnd> parts_;
};

/// An object in the scene's coordinates, as a map makes it that has no inverse. Normals are left out.
template <class T>
Object<T> written_out(const Object<T>& object, const Affine<3>& to_scene) {
    Object<T> out = object;
    for (auto& v : out.mesh.vertices) {
        const Vec3d p = to_scene.point(Vec3d(v));
        v = {rounded<T>(p[0]), rounded<T>(p[1]), rounded<T>(p[2])};
    }
    out.attributes.normals = {};
    return out;
}

template <class T>
class GltfModelReader {
public:
    explicit GltfModelReader(const ModelContext& context)
        : context_(context), file_(context.file, context.path) {
        for (const std::string& extension : file_.texts("extensionsRequired"))
            if (!is_read_by_models(extension))
                file_.fail("requires the extension " + shown(extension) +
                           ", which load_model does not read. Export it without");
    }

    Model<T> read() {
        tell_unused();
        for (const GltfPlacedNode& node : placed_nodes(file_)) {
            file_.expect_not_cancelled();
            if (const auto mesh = file_.number(*node.node, "mesh")) add_instance(node, *mesh);
            if (const auto camera = file_.number(*node.node, "camera"))
                model_.cameras.push_back(camera_of(file_, node, *camera));
            if (const Json* const light = file_.extension(*node.node, "KHR_lights_punctual"))
                model_.lights.push_back(
                    light_of(file_, node, file_.needed_number(*light, "light"), context_.not_shown));
        }
        if (model_.materials.empty()) model_.materials.push_back(GltfMaterials::standard());
        return std::move(model_);
    }

private:
    /// Names what the file uses and a model does not have. Extensions of materials are named where they are
    /// used.
    void tell_unused() {
        for (const std::string& extension : file_.texts("extensionsUsed"))
            if (!is_read_by_models(extension) && !extension.starts_with("KHR_materials_"))
                context_.not_shown.add(extension);
        for (const char* const key : {"animations", "skins"})
            if (file_.count(key) > 0) context_.not_shown.add(std::string(key) + " (glTF)");
    }
    void add_instance(const GltfPlacedNode& node, std::uint64_t mesh) {
        const auto object = object_of(mesh);
        if (!object) return;
        PlacedObject placed;
        placed.name = file_.text(*node.node, "name");
        try {
            placed.to_world = Transform<3>(node.to_scene.linear, node.to_scene.shift);
            placed.object = *object;
        } catch (const InputError&) {  // flat, or almost
            placed.object = static_cast<std::uint32_t>(model_.objects.size());
            constexpr std::uint64_t bytes_a_triangle = 64;  // about: indices, vertices and values at corners
            expect_memory(file_.name(), "an instance that is flat",
                          model_.objects[*object].mesh.size() * bytes_a_triangle);
            model_.objects.push_back(written_out(model_.objects[*object], node.to_scene));
        }
        model_.instances.push_back(std::move(placed));
    }
    /// The object of a mesh; nothing if the mesh has no triangles.
    std::optional<std::uint32_t> object_of(std::uint64_t number) {
        const GltfMesh& mesh = meshes_.mesh(number);
        if (mesh.triangles == 0) return std::nullopt;
        const auto [found, is_new] =
            objects_.try_emplace(number, static_cast<std::uint32_t>(model_.objects.size()));
        if (!is_new) return found->second;
        check_room(context_.file, mesh.triangles, "triangles");
        ObjectBuilder<T> builder(context_, file_, meshes_);
        for (const GltfPart& part : mesh.parts) {
            if (part.primitive->contains("targets")) context_.not_shown.add("morph targets (glTF)");
            builder.add(part, material_of(*part.primitive));
        }
        const Json& json = file_.object("meshes", number);
        model_.objects.push_back(builder.take(file_.text(json, "name")));
        tell_other_primitives(json, mesh);
        return found->second;
    }
    void tell_other_primitives(const Json& json, const GltfMesh& mesh) {
        if (json["primitives"].size() > mesh.parts.size())
            context_.not_shown.add("primitives that are no triangles (glTF)");
    }
    /// The material of a primitive, as an ordinal in the model.
    std::uint32_t material_of(const Json& primitive) {
        const auto number = file_.number(primitive, "material");
        const auto [found, is_new] =
            known_materials_.try_emplace(number, static_cast<std::uint32_t>(model_.materials.size()));
        if (is_new) model_.materials.push_back(number ? materials_.read(*number) : GltfMaterials::standard());
        return found->second;
    }

    ModelContext context_;
    GltfFile file_;
    GltfMeshes meshes_{file_};
    GltfMaterials materials_{file_, context_.textures, context_.not_shown};
    Model<T> model_;
    std::map<std::uint64_t, std::uint32_t> objects_;                         // by the number of the mesh
    std::map<std::optional<std::uint64_t>, std::uint32_t> known_materials_;  // none: the standard one
};

}  // namespace

template <class T>
Model<T> read_gltf_model(const ModelContext& context) {
    return GltfModelReader<T>(context).read();
}

template Model<float> read_gltf_model(const ModelContext&);
template Model<double> read_gltf_model(const ModelContext&);

}  // namespace hedgerow::detail
