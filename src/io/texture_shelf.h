/// The textures of a model while it is read: each image is decoded once, and each way to look it up is one
/// texture.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <hedgerow/io/model_file.h>
#include <hedgerow/looks/texture.h>

#include "named_once.h"

namespace hedgerow::detail {

class TextureShelf {
public:
    TextureShelf(const ModelOptions& options, const Progress& progress, NamedOnce& warnings)
        : options_(options), progress_(progress), warnings_(warnings) {}

    /// The ordinal of a texture that is like `description`, which says everything but the pixels.
    /// `description.name` identifies the image, and `load` decodes it. If that throws InputError, there is a
    /// warning, and the texture is magenta if `is_colour`; else there is none. Throws Cancelled before an
    /// image is decoded if the progress is cancelled.
    std::optional<std::uint32_t> texture(const Texture& description, bool is_colour,
                                         const std::function<Pixels(const PixelLimits&)>& load);
    const Texture& operator[](std::uint32_t ordinal) const { return textures_[ordinal]; }
    std::vector<Texture> take() { return std::move(textures_); }

private:
    using Kind = std::tuple<std::string, ColourSpace, Wrap, Wrap, TextureFilter>;

    /// The pixels of an image; null if they cannot be read.
    std::shared_ptr<const Pixels> pixels_of(const std::string& name,
                                            const std::function<Pixels(const PixelLimits&)>& load);

    ModelOptions options_;
    Progress progress_;
    NamedOnce& warnings_;
    std::map<std::string, std::shared_ptr<const Pixels>> images_;
    std::map<Kind, std::uint32_t> known_;
    std::vector<Texture> textures_;
};

}  // namespace hedgerow::detail
