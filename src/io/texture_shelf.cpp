#include "texture_shelf.h"

#include <hedgerow/base/error.h>

namespace hedgerow::detail {

namespace {

/// What stands for a colour whose image is missing: nothing else is magenta by chance.
std::shared_ptr<const Pixels> magenta() {
    static const auto pixels =
        std::make_shared<const Pixels>(Pixels{1, 1, 3, std::vector<std::uint8_t>{255, 0, 255}});
    return pixels;
}

}  // namespace

std::optional<std::uint32_t> TextureShelf::texture(const Texture& description, bool is_colour,
                                                   const std::function<Pixels(const PixelLimits&)>& load) {
    std::shared_ptr<const Pixels> pixels = pixels_of(description.name, load);
    if (!pixels && !is_colour) return std::nullopt;
    const Kind kind{description.name, description.space, description.wrap_s, description.wrap_t,
                    description.filter};
    const auto [found, is_new] = known_.try_emplace(kind, static_cast<std::uint32_t>(textures_.size()));
    if (is_new) {
        textures_.push_back(description);
        textures_.back().pixels = pixels ? pixels : magenta();
    }
    return found->second;
}

std::shared_ptr<const Pixels> TextureShelf::pixels_of(const std::string& name,
                                                      const std::function<Pixels(const PixelLimits&)>& load) {
    const auto [found, is_new] = images_.try_emplace(name);
    if (!is_new) return found->second;
    progress_.look();
    if (!options_.textures) return found->second = std::make_shared<const Pixels>();
    try {
        found->second = std::make_shared<const Pixels>(load(options_.limits));
    } catch (const InputError& error) {
        warnings_.add(std::string(error.what()) +
                      ". A colour of this texture is magenta; other properties are without it");
    }
    return found->second;
}

}  // namespace hedgerow::detail
