/// Wavefront OBJ with its materials, normals, texture coordinates and colours of vertices.
#include <array>
#include <optional>

#include <hedgerow/base/error.h>

#include "corner_values.h"
#include "gltf_uri.h"
#include "model_readers.h"
#include "mtl.h"
#include "obj_reader.h"

namespace hedgerow::detail {

namespace {

/// What the lines of a file say besides vertices and faces.
class ObjLooks {
public:
    enum List : std::size_t { coordinates, normals, lists };

    explicit ObjLooks(const ModelContext& context) : context_(context) {}

    void vertex(std::string_view rest, std::uint64_t ordinal, const ObjPlace& place) {
        // Three more numbers are a colour, as a screen shows it; one more is a weight.
        std::array<std::string_view, 3> words;
        rest = rest.substr(0, rest.find('#'));
        for (auto& word : words) word = take_word(rest);
        if (words[2].empty()) {
            if (!colours_.empty()) append(place.file, colours_, white);
            return;
        }
        while (colours_.size() < ordinal) append(place.file, colours_, white);
        Rgba colour;
        for (int k = 0; k < 3; ++k)
            colour.colour[k] = static_cast<float>(
                srgb_to_linear(static_cast<double>(number(words[static_cast<std::size_t>(k)], place))));
        append(place.file, colours_, colour);
    }
    void line(std::string_view word, std::string_view rest, const ObjPlace& place) {
        if (word == "vt") {
            const float u = number(take_word(rest), place);
            const std::string_view v = take_word(rest);
            append(place.file, coordinates_, Vec2f(u, v.empty() ? 1 : 1 - number(v, place)));
        } else if (word == "vn") {
            Vec3f n;
            for (int k = 0; k < 3; ++k) n[k] = number(take_word(rest), place);
            append(place.file, normals_, n);
        } else if (word == "usemtl") {
            begin_material(std::string(trimmed(rest)));
        } else if (word == "mtllib") {
            libraries_.add(std::string(trimmed(rest)));
        } else if (word == "l" || word == "p" || word == "curv" || word == "surf") {
            context_.not_shown.add("lines, points and curves (OBJ)");
        }
    }
    void corner(std::string_view rest, const ObjPlace& place) {
        if (rest.starts_with('/')) rest.remove_prefix(1);
        const auto slash = std::min(rest.find('/'), rest.size());
        const std::string_view normal = slash < rest.size() ? rest.substr(slash + 1) : std::string_view();
        append(place.file, corners_[coordinates],
               ordinal(rest.substr(0, slash), coordinates_.size(), "texture coordinate", place));
        append(place.file, corners_[normals], ordinal(normal, normals_.size(), "normal", place));
    }
    std::span<const std::vector<std::uint32_t>> corners() const { return corners_; }
    void end_face(std::uint64_t triangles) {
        for (auto& list : corners_) list.clear();
        triangles_ = triangles;
    }

    /// Moves all that was read into a model whose mesh has been read.
    template <class T, class Reader>
    void move_to(Model<T>& model, Reader& reader) {
        Object<T>& object = model.objects[0];
        Attributes& attributes = object.attributes;
        if (auto list = reader.take_others(coordinates); !list.empty())
            attributes.texture_coordinates.push_back({std::move(coordinates_), std::move(list)});
        if (auto list = reader.take_others(normals); !list.empty())
            attributes.normals = {std::move(normals_), std::move(list)};
        has_colours_ = !colours_.empty();
        attributes.colours.values = std::move(colours_);
        check_attributes(context_.file, object.mesh, attributes, context_.warnings);
        read_libraries();
        move_materials_to(model);
    }

private:
    static constexpr Rgba white{Vec3f(1, 1, 1), 1};

    static float number(std::string_view word, const ObjPlace& place) {
        const auto x = parse_real<float>(word);
        if (!x) place.fail(shown(word) + " where a number should stand. Repair the file");
        return *x;
    }
    /// The ordinal that a word of a face names; `nothing` for an empty word.
    static std::uint32_t ordinal(std::string_view word, std::size_t count, const char* what,
                                 const ObjPlace& place) {
        if (word.empty()) return FaceList::nothing;
        const auto index = parse_integer<std::int64_t>(word);
        if (!index || *index == 0)
            place.fail(std::string("the face names ") + what + " " + shown(word) +
                       ". Indices are whole numbers and begin at 1");
        if (count == 0) return 0;  // there is none yet; check_attributes tells whether one came
        const std::int64_t v = *index > 0 ? *index - 1 : static_cast<std::int64_t>(count) + *index;
        if (v < 0 || v >= static_cast<std::int64_t>(most_ordinals))
            place.fail(std::string("the face names ") + what + " " + std::to_string(*index) +
                       ", but there are only " + std::to_string(count) + " so far. Repair the file");
        return static_cast<std::uint32_t>(v);
    }

    /// Material names, and the triangle from which on each is used.
    struct Run {
        std::uint64_t first;
        std::string material;
    };
    void begin_material(std::string name) {
        if (!runs_.empty() && runs_.back().first == triangles_)
            runs_.back().material = std::move(name);
        else if (runs_.empty() || runs_.back().material != name)
            runs_.push_back({triangles_, std::move(name)});
    }

    /// A line names one library whose name may have blanks, or several libraries.
    void read_libraries() {
        for (const std::string& line : libraries_.take()) {
            if (is_there(line)) {
                read_library(line);
                continue;
            }
            std::string_view rest = line;
            for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
                read_library(std::string(word));
        }
    }
    std::filesystem::path library(const std::string& name) const {
        return file_beside(name, context_.path, context_.file.name(), "material library");
    }
    bool is_there(const std::string& name) const {
        std::error_code error;
        try {
            return std::filesystem::exists(library(name), error);
        } catch (const InputError&) {
            return false;
        }
    }
    void read_library(const std::string& name) {
        if (!is_there(name)) {
            context_.warnings.add(context_.file.name() + ": its material library " + shown(name) +
                                  " is not in its folder. What it would colour is grey");
            return;
        }
        read_mtl(library(name), context_, materials_);
    }

    template <class T>
    void move_materials_to(Model<T>& model) {
        if (!runs_.empty() && runs_.back().first == triangles_) runs_.pop_back();
        if (runs_.empty() || runs_.front().first > 0) runs_.insert(runs_.begin(), Run{0, ""});
        std::map<std::string, std::uint32_t> ordinals;
        std::vector<std::uint32_t> of_run;
        for (const Run& run : runs_) {
            const auto [found, is_new] =
                ordinals.try_emplace(run.material, static_cast<std::uint32_t>(model.materials.size()));
            if (is_new) model.materials.push_back(material(run.material));
            of_run.push_back(found->second);
        }
        Object<T>& object = model.objects[0];
        object.material = of_run[0];
        if (model.materials.size() == 1) return;
        expect_memory(context_.file.name(), "the materials of its triangles",
                      triangles_ * sizeof(std::uint32_t));
        object.materials.resize(object.mesh.size());
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto end = static_cast<std::size_t>(r + 1 < runs_.size() ? runs_[r + 1].first : triangles_);
            for (auto i = static_cast<std::size_t>(runs_[r].first); i < end; ++i)
                object.materials[i] = of_run[r];
        }
    }
    /// A material of the libraries. Without one, the surface is grey, and where vertices have colours, white.
    Material material(const std::string& name) {
        const auto found = materials_.find(name);
        if (found != materials_.end()) return found->second;
        if (!name.empty())
            context_.warnings.add(context_.file.name() + ": the material " + shown(name) +
                                  " is in none of its libraries. What it would colour is grey");
        Material plain;
        plain.name = name;
        if (has_colours_) plain.base_colour = Vec3f::all(1);
        return plain;
    }

    ModelContext context_;
    std::vector<Vec2f> coordinates_;
    std::vector<Vec3f> normals_;
    std::vector<Rgba> colours_;
    bool has_colours_ = false;
    std::array<std::vector<std::uint32_t>, lists> corners_;
    std::uint64_t triangles_ = 0;
    std::vector<Run> runs_;
    NamedOnce libraries_;  // lines that name some
    MaterialsByName materials_;
};

}  // namespace

template <class T>
Model<T> read_obj_model(const ModelContext& context) {
    ObjLooks looks(context);
    ObjReader<T, ObjLooks> reader(context.file, looks);
    Model<T> model = model_of(context.path, reader.read());
    looks.move_to(model, reader);
    return model;
}

template Model<float> read_obj_model(const ModelContext&);
template Model<double> read_obj_model(const ModelContext&);

}  // namespace hedgerow::detail
