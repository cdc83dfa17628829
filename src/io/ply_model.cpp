/// PLY with its normals, colours and texture coordinates, of vertices and of faces.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>

#include "corner_values.h"
#include "gltf_uri.h"
#include "model_readers.h"
#include "ply_elements.h"

namespace hedgerow::detail {

namespace {

/// A number of an entry that has a place among its wanted numbers.
struct PlyField {
    std::size_t place = 0;
    PlyType type = PlyType::f4;

    /// The number; a whole number as a share of the largest of its type.
    double share(const std::vector<float>& numbers) const {
        constexpr double largest[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 0x1p63, 0x1p64, 1, 1};
        const double x = static_cast<double>(numbers[place]) / largest[static_cast<int>(type)];
        return is_whole() ? std::clamp(x, 0.0, 1.0) : x;  // text may have any number
    }
    /// A linear component of a colour. Whole numbers are sRGB.
    float colour(const std::vector<float>& numbers) const {
        const double x = share(numbers);
        return static_cast<float>(is_whole() ? srgb_to_linear(x) : x);
    }
    bool is_whole() const { return type < PlyType::f4; }
};

/// Finds properties of an element by name, and remembers which were found.
class PlyFields {
public:
    PlyFields(const PlyElement& element, PlyWanted& wanted)
        : element_(element), wanted_(wanted), used_(element.properties.size()) {}

    /// The fields of these names: all, or nothing if one is missing or is a list.
    std::vector<PlyField> find(std::initializer_list<std::string_view> names) {
        std::vector<int> places;
        for (const std::string_view name : names) {
            const int k = place(name, false);
            if (k < 0) return {};
            places.push_back(k);
        }
        std::vector<PlyField> fields;
        for (const int k : places) {
            used_[static_cast<std::size_t>(k)] = true;
            fields.push_back({wanted_.numbers.size(), element_.properties[static_cast<std::size_t>(k)].type});
            wanted_.numbers.push_back(k);
        }
        return fields;
    }
    /// The first of several alternatives that is there.
    std::vector<PlyField> find_any(
        std::initializer_list<std::initializer_list<std::string_view>> alternatives) {
        for (const auto names : alternatives)
            if (auto fields = find(names); !fields.empty()) return fields;
        return {};
    }
    std::vector<PlyField> find_colour() {
        return find_any({{"red", "green", "blue", "alpha"},
                         {"red", "green", "blue"},
                         {"diffuse_red", "diffuse_green", "diffuse_blue"},
                         {"r", "g", "b", "a"},
                         {"r", "g", "b"}});
    }
    void find_list(std::string_view name) {
        wanted_.list = place(name, true);
        if (wanted_.list >= 0) used_[static_cast<std::size_t>(wanted_.list)] = true;
    }
    /// Adds the properties that nothing wants to a list.
    void tell_unused(NamedOnce& not_shown) const {
        for (std::size_t k = 0; k < used_.size(); ++k)
            if (const auto at = static_cast<int>(k);
                !used_[k] && wanted_.axis_of(at) == 3 && at != wanted_.corners)
                not_shown.add("property " + shown(element_.properties[k].name) + " (PLY)");
    }

private:
    int place(std::string_view name, bool is_list) const {
        for (std::size_t k = 0; k < element_.properties.size(); ++k)
            if (const PlyProperty& p = element_.properties[k];
                p.name == name && p.count.has_value() == is_list)
                return static_cast<int>(k);
        return -1;
    }

    const PlyElement& element_;
    PlyWanted& wanted_;
    std::vector<bool> used_;
};

Rgba colour_of(const std::vector<PlyField>& fields, const std::vector<float>& numbers) {
    Rgba colour;
    for (int k = 0; k < 3; ++k) colour.colour[k] = fields[static_cast<std::size_t>(k)].colour(numbers);
    if (fields.size() == 4) colour.alpha = static_cast<float>(fields[3].share(numbers));
    return colour;
}

template <class T>
class PlyModelReader {
public:
    explicit PlyModelReader(const ModelContext& context)
        : context_(context), file_(context.file), header_(read_ply_header(file_)), values_(file_, header_) {}

    Model<T> read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else if (element.name == "tristrips")
                read_strips(element);
            else
                skip(element);
        }
        values_.tell_surplus();
        Model<T> model = model_of(context_.path, std::move(mesh_));
        Object<T>& object = model.objects[0];
        faces_.move_to(object.mesh);
        object.materials = std::move(materials_);
        move_attributes_to(object);
        model.materials = materials_of_textures(object.attributes);
        return model;
    }

private:
    enum List : std::size_t { wedge_coordinates, face_colours, lists };

    void read_vertices(const PlyElement& element) {
        PlyWanted wanted = coordinates_of(file_, element);
        if (element.count > 0) need_axes(file_, wanted, 3);
        PlyFields fields(element, wanted);
        const auto normal = fields.find({"nx", "ny", "nz"});
        const auto colour = fields.find_colour();
        const auto place = fields.find_any({{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}});
        fields.tell_unused(context_.not_shown);
        read_element(values_, element, wanted, sizeof(Vec<T, 3>), [&](const PlyEntry<T>& entry) {
            const auto& n = entry.numbers;
            const auto raw = [&](const PlyField& field) { return n[field.place]; };
            append(file_, mesh_.vertices, entry.point);
            if (!normal.empty())
                append(file_, normals_, Vec3f(raw(normal[0]), raw(normal[1]), raw(normal[2])));
            if (!colour.empty()) append(file_, vertex_colours_, colour_of(colour, n));
            if (!place.empty()) append(file_, coordinates_, Vec2f(raw(place[0]), 1 - raw(place[1])));
        });
    }
    void read_faces(const PlyElement& element) {
        PlyWanted wanted = corners_of(file_, element);
        PlyFields fields(element, wanted);
        const auto colour = fields.find_colour();
        const auto texture = fields.find({"texnumber"});
        fields.find_list("texcoord");
        fields.tell_unused(context_.not_shown);
        std::array<std::vector<std::uint32_t>, lists> others;
        read_element(values_, element, wanted, sizeof(TriangleIndices), [&](const PlyEntry<T>& entry) {
            // A pair of coordinates for each corner, or none for the face.
            const std::size_t corners = entry.corners.size();
            others[wedge_coordinates].assign(corners, FaceList::nothing);
            for (std::size_t i = 0; entry.list.size() == 2 * corners && i < corners; ++i) {
                others[wedge_coordinates][i] = static_cast<std::uint32_t>(wedges_.size());
                append(file_, wedges_, Vec2f(entry.list[2 * i], 1 - entry.list[2 * i + 1]));
            }
            others[face_colours].assign(corners, FaceList::nothing);
            if (!colour.empty()) {
                others[face_colours].assign(corners, static_cast<std::uint32_t>(colours_.size()));
                append(file_, colours_, colour_of(colour, entry.numbers));
            }
            check_room(file_, wedges_.size() + colours_.size(), "texture coordinates and colours");
            faces_.add(entry.corners, others);
            // The material of the face's triangles is the ordinal of its texture.
            if (texture.empty() || header_.textures.empty()) return;
            const float number = entry.numbers[texture[0].place];
            const auto last = static_cast<float>(header_.textures.size() - 1);
            const float named = number >= 0 && number <= last ? number : 0;
            while (materials_.size() < faces_.triangle_count())
                append(file_, materials_, static_cast<std::uint32_t>(named));
        });
    }
    void read_strips(const PlyElement& element) {
        PlyWanted wanted = corners_of(file_, element);
        PlyFields(element, wanted).tell_unused(context_.not_shown);
        std::array<std::vector<std::uint32_t>, lists> others;
        for (auto& list : others) list.assign(3, FaceList::nothing);
        read_element(values_, element, wanted, sizeof(TriangleIndices), [&](const PlyEntry<T>& entry) {
            for_each_of_strips(entry.corners, [&](const auto& t) { faces_.add(t, others); });
            if (header_.textures.empty()) return;
            while (materials_.size() < faces_.triangle_count()) append(file_, materials_, 0u);
        });
    }
    void skip(const PlyElement& element) {
        if (element.count > 0) context_.not_shown.add("element " + shown(element.name) + " (PLY)");
        read_element(values_, element, PlyWanted{}, 0, [](const PlyEntry<T>&) {});
    }

    /// Values of corners and faces count before those of vertices.
    void move_attributes_to(Object<T>& object) {
        Attributes& attributes = object.attributes;
        attributes.normals.values = std::move(normals_);
        if (auto list = faces_.take_others(wedge_coordinates); !list.empty())
            attributes.texture_coordinates.push_back({std::move(wedges_), std::move(list)});
        else if (!coordinates_.empty())
            attributes.texture_coordinates.push_back({std::move(coordinates_), {}});
        if (!vertex_colours_.empty() && !colours_.empty())
            context_.not_shown.add("colours of vertices whose faces have others (PLY)");
        if (auto list = faces_.take_others(face_colours); !list.empty())
            attributes.colours = {std::move(colours_), std::move(list)};
        else
            attributes.colours.values = std::move(vertex_colours_);
        check_attributes(file_, object.mesh, attributes, context_.warnings);
    }
    /// A material for each texture of the header; one without a texture if there is none.
    std::vector<Material> materials_of_textures(const Attributes& attributes) {
        std::vector<Material> materials(std::max<std::size_t>(header_.textures.size(), 1));
        const bool has_colours = !attributes.colours.empty();
        for (std::size_t i = 0; i < materials.size(); ++i) {
            Material& m = materials[i];
            if (has_colours || !header_.textures.empty()) m.base_colour = Vec3f::all(1);
            if (header_.textures.empty() || attributes.texture_coordinates.empty()) continue;
            m.name = header_.textures[i];
            Texture like;
            like.name = header_.textures[i];
            like.space = ColourSpace::srgb;
            const auto ordinal = context_.textures.texture(like, true, [&](const PixelLimits& limits) {
                return load_pixels(file_beside(like.name, context_.path, file_.name(), "texture"), limits);
            });
            m.base_colour_texture.texture = ordinal.value_or(no_texture);
        }
        return materials;
    }

    ModelContext context_;
    ByteSource& file_;
    PlyHeader header_;
    PlyValues<T> values_;
    TriangleMesh<T> mesh_;
    FaceList faces_{file_};
    std::vector<std::uint32_t> materials_;
    std::vector<Vec3f> normals_;                  // of vertices
    std::vector<Vec2f> coordinates_, wedges_;     // of vertices and of corners
    std::vector<Rgba> vertex_colours_, colours_;  // of vertices and of faces
};

}  // namespace

template <class T>
Model<T> read_ply_model(const ModelContext& context) {
    return PlyModelReader<T>(context).read();
}

template Model<float> read_ply_model(const ModelContext&);
template Model<double> read_ply_model(const ModelContext&);

}  // namespace hedgerow::detail
