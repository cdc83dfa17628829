/// OFF with its normals, colours and texture coordinates of vertices, and colours of faces (Geomview's
/// manual, "OFF Files").
#include <algorithm>
#include <array>
#include <optional>

#include "corner_values.h"
#include "model_readers.h"
#include "off_reader.h"

namespace hedgerow::detail {

namespace {

/// The numbers that follow the coordinates of vertices and the corners of faces.
class OffLooks {
public:
    explicit OffLooks(const ModelContext& context) : context_(context) {}

    void begin(std::string_view letters) {
        const std::string lower = lower_case(letters);
        has_places_ = lower.starts_with("st");
        has_colours_ = lower.find('c') != lower.npos;
        has_normals_ = lower.find('n') != lower.npos;
        normals_.clear(), places_.clear(), vertex_colours_.clear(), face_colours_.clear();
    }
    /// Normals come first, then colours, then texture coordinates. What is missing stays 0, or white.
    void vertex(std::string_view rest, const ByteSource& file) {
        if (!has_normals_ && !has_colours_ && !has_places_) return;
        read_words(rest);
        std::size_t at = 0;
        const auto next = [&] { return at < count_ ? number(words_[at++]) : 0.f; };
        if (has_normals_) {
            const float x = next(), y = next(), z = next();
            append(file, normals_, Vec3f(x, y, z));
        }
        if (has_colours_) {
            const std::size_t end = std::max(at, count_ - std::min<std::size_t>(count_, has_places_ ? 2 : 0));
            append(file, vertex_colours_, colour(at, end).value_or(Rgba{Vec3f::all(1), 1}));
            at = end;
        }
        if (has_places_) {
            const float u = next(), v = next();
            append(file, places_, Vec2f(u, 1 - v));
        }
    }
    std::span<const std::vector<std::uint32_t>> face(std::string_view rest, std::size_t corners) {
        read_words(rest);
        const auto of_face = colour(0, count_);
        if (count_ == 1) context_.not_shown.add("colours by a number of a colour map (OFF)");
        ordinals_[0].assign(corners, FaceList::nothing);
        if (of_face) {
            ordinals_[0].assign(corners, static_cast<std::uint32_t>(face_colours_.size()));
            append(context_.file, face_colours_, *of_face);
        }
        return ordinals_;
    }

    /// Colours of faces count before those of vertices.
    template <class T>
    void move_to(Model<T>& model, std::vector<TriangleIndices> of_faces) {
        Object<T>& object = model.objects[0];
        Attributes& a = object.attributes;
        a.normals.values = std::move(normals_);
        if (has_places_) a.texture_coordinates.push_back({std::move(places_), {}});
        if (!of_faces.empty() && has_colours_)
            context_.not_shown.add("colours of vertices whose faces have others (OFF)");
        if (!of_faces.empty())
            a.colours = {std::move(face_colours_), std::move(of_faces)};
        else
            a.colours.values = std::move(vertex_colours_);
        check_attributes(context_.file, object.mesh, a, context_.warnings);
        model.materials.emplace_back();
        if (!a.colours.empty()) model.materials[0].base_colour = Vec3f::all(1);
    }

private:
    static constexpr std::size_t most_words = 9;  // three, four and two numbers

    void read_words(std::string_view rest) {
        count_ = 0;
        for (std::string_view word = take_word(rest); !word.empty() && count_ < most_words;
             word = take_word(rest))
            words_[count_++] = word;
    }
    /// A word that is no number is not finite, and is left out with a warning.
    static float number(std::string_view word) {
        return parse_real<float>(word).value_or(std::numeric_limits<float>::quiet_NaN());
    }
    /// The colour in words [begin, end): three or four numbers, whole ones from 0 to 255 in sRGB, others
    /// linear.
    std::optional<Rgba> colour(std::size_t begin, std::size_t end) const {
        if (end - begin != 3 && end - begin != 4) return std::nullopt;
        const auto words = std::span(words_).subspan(begin, end - begin);
        const bool is_whole = std::all_of(
            words.begin(), words.end(), [](std::string_view w) { return parse_integer<int>(w).has_value(); });
        std::array<float, 4> parts{0, 0, 0, 1};
        for (std::size_t k = 0; k < words.size(); ++k) {
            const double x = static_cast<double>(number(words[k]));
            const double share = is_whole ? std::clamp(x / 255, 0.0, 1.0) : x;
            parts[k] = static_cast<float>(is_whole && k < 3 ? srgb_to_linear(share) : share);
        }
        return Rgba{Vec3f(parts[0], parts[1], parts[2]), parts[3]};
    }

    ModelContext context_;
    bool has_places_ = false, has_colours_ = false, has_normals_ = false;
    std::array<std::string_view, most_words> words_;
    std::size_t count_ = 0;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> places_;
    std::vector<Rgba> vertex_colours_, face_colours_;
    std::array<std::vector<std::uint32_t>, 1> ordinals_;
};

}  // namespace

template <class T>
Model<T> read_off_model(const ModelContext& context) {
    OffLooks looks(context);
    OffReader<T, OffLooks> reader(context.file, looks);
    Model<T> model = model_of(context.path, reader.read());
    looks.move_to(model, reader.take_others(0));
    return model;
}

template Model<float> read_off_model(const ModelContext&);
template Model<double> read_off_model(const ModelContext&);

}  // namespace hedgerow::detail
