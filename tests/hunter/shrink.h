/// Shrinks a scene and a query that fail to a smaller and plainer scene and query that still fail.
#pragma once

#include <cmath>
#include <vector>

#include "shapes.h"

namespace hedgerow::hunter {

/// Leaves out shapes for which `fails(shapes)` stays true: first half of the shapes at a time, at last one by
/// one (the greedy part of Zeller and Hildebrandt 2002).
template <class Shape, class Fails>
std::vector<Shape> fewer(std::vector<Shape> shapes, Fails fails) {
    for (std::size_t piece = shapes.size() / 2; piece > 0; piece /= 2)
        for (std::size_t at = 0; at < shapes.size();) {
            auto rest = shapes;
            const std::size_t end = std::min(rest.size(), at + piece);
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at),
                       rest.begin() + static_cast<std::ptrdiff_t>(end));
            if (!rest.empty() && fails(rest))
                shapes = std::move(rest);
            else
                at += piece;
        }
    return shapes;
}

/// Replaces each number of `thing` by a plainer value for which `fails()`, which reads `thing`, stays true.
template <class Thing, class Fails>
void plainer(Thing& thing, Fails fails) {
    for_each_number(thing, [&](auto& x) {
        using T = std::remove_reference_t<decltype(x)>;
        if (!(std::abs(x) < std::numeric_limits<T>::infinity())) return;
        const T steps[] = {T(0),
                           T(1),
                           std::nearbyint(x),
                           std::nearbyint(x * 8) / 8,
                           std::nearbyint(x * 1024) / 1024,
                           static_cast<T>(static_cast<float>(x))};
        for (const T plain : steps) {
            const T before = x;
            if (x == plain) return;
            x = plain;
            if (fails()) return;
            x = before;
        }
    });
}

template <class Shape, class Question, class Fails>
void shrink(std::vector<Shape>& shapes, Question& question, Fails fails) {
    shapes = fewer(shapes, [&](const std::vector<Shape>& some) { return fails(some, question); });
    const auto still = [&] { return fails(shapes, question); };
    plainer(question, still);
    if (shapes.size() <= 64)
        for (auto& shape : shapes) plainer(shape, still);
    shapes = fewer(shapes, [&](const std::vector<Shape>& some) { return fails(some, question); });
}

}  // namespace hedgerow::hunter
