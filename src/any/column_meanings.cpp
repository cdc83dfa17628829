/// What the columns of questions mean.
#include <algorithm>
#include <iterator>

#include <hedgerow/any_question.h>

std::string_view hedgerow::meaning_of_column(std::string_view name) {
    struct Known {
        std::string_view name, meaning;
    };
    static constexpr Known known[] = {
        {"ox", "the origin of a ray"},
        {"dx", "the direction of a ray, of any length"},
        {"t_min", "where the ray begins, in lengths of its direction"},
        {"t_max", "where the ray ends, in lengths of its direction; may be infinite"},
        {"x",
         "a place, in units of the scene: of the row, the point or the center of the ball; of an answer, the "
         "point that was found"},
        {"low_x", "the low corner of a box; may be infinite"},
        {"high_x", "the high corner of a box; may be infinite"},
        {"query", "the number of the row that was asked, from 0"},
        {"primitive", "the number of the primitive in the scene's file, 4294967295 where nothing was found"},
        {"t", "where the ray hits, in lengths of its direction; infinite where it does not"},
        {"u", "the surface's own first coordinate there"},
        {"v", "the surface's own second coordinate there"},
        {"hit", "whether anything is hit"},
        {"distance",
         "in units of the scene, not squared; infinite where nothing was found. A signed one is "
         "negative inside"},
        {"feature", "0 for a face, 1 for an edge, 2 for a vertex, -128 where nothing was found"},
        {"number", "of the vertex, or of the edge that begins there"},
        {"weight_a", "the weight of the first corner"},
        {"weight_b", "the weight of the second corner"},
        {"weight_c", "the weight of the third corner"},
        {"nx", "the normal there, of length 1; 0 for a triangle without area"},
        {"count", "how many primitives"},
        {"overlaps", "whether any primitive does"},
        {"side", "-1 outside, 0 on the surface, 1 inside, -128 for a row without an answer"},
        {"winding_number", "turns of the surface around the point"}};
    // Columns of the other axes are those of x.
    std::string first(name);
    if (!first.empty() && (first.back() == 'y' || first.back() == 'z')) first.back() = 'x';
    for (const std::string_view asked : {name, std::string_view(first)}) {
        const auto* const found =
            std::find_if(std::begin(known), std::end(known), [&](const Known& k) { return k.name == asked; });
        if (found != std::end(known)) return found->meaning;
    }
    return {};
}
