/// A corpus of small files: every variant of the formats that programs write, each with the geometry that it
/// must give.
#pragma once

#include <vector>

#include "corpus/file.h"
#include "corpus/gltf.h"
#include "corpus/meshes.h"
#include "corpus/points.h"

namespace hedgerow::testing_corpus {

inline std::vector<CorpusFile> corpus() {
    std::vector<CorpusFile> all;
    add_obj(all), add_mtl(all), add_ply(all), add_stl(all), add_off(all), add_gltf(all), add_rows(all),
        add_npy(all);
    return all;
}

}  // namespace hedgerow::testing_corpus
