/// Draws lines in space over a picture, faint where a surface hides them.
#pragma once

#include <limits>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/io/image.h>
#include <hedgerow/render/camera/ray_maker.h>

namespace hedgerow {

/// A line in space, `width` pixels wide.
struct SpaceLine {
    Vec3f a, b;
    Image::Pixel colour{};
    float width = 1;
};

/// The distance forward of the eye of the surface at each pixel, row by row; infinite where there is none.
template <class T>
std::vector<float> depths(const AnyIndex<T, 3>& index, const RayMaker& maker, int width, int height,
                          Executor& executor) {
    std::vector<float> all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    executor.for_each_piece(static_cast<std::size_t>(height), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray<T, 3>> rays(static_cast<std::size_t>(width));
        std::vector<Hit<T>> hits(rays.size());
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < rays.size(); ++x)
                rays[x] = maker.ray<T>(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            closest_hits(index, rays, hits);
            for (std::size_t x = 0; x < rays.size(); ++x)
                all[y * rays.size() + x] =
                    hits[x] ? static_cast<float>(hits[x].t) * maker.forward_of(Vec3f(rays[x].direction))
                            : std::numeric_limits<float>::infinity();
        }
    });
    return all;
}

/// Draws lines in the order of the calls, each over those before.
class Wireframe {
public:
    /// `depths` are those of the picture, pixel by pixel. Image, depths and maker must outlive this.
    Wireframe(Image& image, const std::vector<float>& depths, const RayMaker& maker)
        : image_(image), depths_(depths), maker_(maker) {}

    void draw(const SpaceLine& line) {
        Vec3f a = line.a, b = line.b;
        if (!before_the_eye(a, b)) return;
        // Project the ends, and step along the axis on which the line is longer.
        Vec3f p = maker_.seen(a), q = maker_.seen(b);
        const int along = std::abs(q[0] - p[0]) >= std::abs(q[1] - p[1]) ? 0 : 1, across = 1 - along;
        if (p[along] > q[along]) std::swap(p, q);
        const float run = q[along] - p[along], slope = run > 0 ? (q[across] - p[across]) / run : 0;
        const float half = line.width / 2 * std::sqrt(1 + product(slope, slope));
        const int size[2] = {image_.width, image_.height};
        const int first = std::max(0, static_cast<int>(std::max(-1.f, std::round(p[along])))),
                  last = std::min(size[along] - 1,
                                  static_cast<int>(std::min(65536.f, std::round(q[along]))) - 1);
        // Draw the pixels across the line at each step, weighted by the share that it covers.
        for (int i = first; i <= last; ++i) {
            const float s = std::min(1.f, std::max(0.f, (static_cast<float>(i) + 0.5f - p[along]) / run));
            const float middle = p[across] + (q[across] - p[across]) * s;
            // 1/forward is linear in picture coordinates.
            const float forward = 1 / (1 / p[2] + (1 / q[2] - 1 / p[2]) * s);
            if (!(middle + half >= 0 && middle - half <= static_cast<float>(size[across]))) continue;
            const int low = std::max(0, static_cast<int>(middle - half)),
                      high = std::min(size[across] - 1, static_cast<int>(middle + half));
            for (int k = low; k <= high; ++k) {
                const auto side = static_cast<float>(k);
                const float cover = std::min(side + 1, middle + half) - std::max(side, middle - half);
                along == 0 ? mix(i, k, line.colour, cover, forward) : mix(k, i, line.colour, cover, forward);
            }
        }
    }

private:
    /// Clips the line to the space before the eye. Returns false if nothing is left.
    bool before_the_eye(Vec3f& a, Vec3f& b) const {
        const float fa = maker_.seen(a)[2], fb = maker_.seen(b)[2];
        const float least = 1e-3f * std::max(std::abs(fa), std::abs(fb));
        if (!(fa > least || fb > least)) return false;
        if (fa < least) a = a + (b - a) * ((least - fa) / (fb - fa));
        if (fb < least) b = b + (a - b) * ((least - fb) / (fa - fb));
        return true;
    }
    void mix(int x, int y, const Image::Pixel& colour, float cover, float forward) {
        // A line up to 0.2 % behind a surface counts as visible, since a box's side often touches what it
        // bounds.
        const float surface = depths_[static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                                      static_cast<std::size_t>(x)];
        const float share = std::min(1.f, cover) * (forward <= surface * 1.002f ? 0.95f : hidden);
        Image::Pixel& pixel = image_.at(x, y);
        for (std::size_t k = 0; k < 3; ++k)
            pixel[k] = static_cast<std::uint8_t>(std::lround(static_cast<float>(pixel[k]) * (1 - share) +
                                                             static_cast<float>(colour[k]) * share));
    }
    static constexpr float hidden = 0.13f;

    Image& image_;
    const std::vector<float>& depths_;
    const RayMaker& maker_;
};

}  // namespace hedgerow
