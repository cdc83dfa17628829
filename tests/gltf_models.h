/// Loads models of glTF from their parts.
#pragma once

#include "gltf_text.h"
#include "model_support.h"

namespace hedgerow::testing_gltf {

class GltfModelTest : public testing::Test {
protected:
    Model<float> load(const Gltf& file) {
        auto model = load_model(folder.file("a.gltf", file.text()));
        testing_io::expect_sound(model);
        return model;
    }
    void refuse(const Gltf& file, std::vector<std::string> parts) {
        parts.insert(parts.begin(), "a.gltf");
        testing_io::expect_input_error([&] { load_model(folder.file("a.gltf", file.text())); }, parts);
    }
    static Gltf with_material(const std::string& members, const std::string& more = "") {
        Gltf file = triangle();
        file.primitive += R"(,"material":0)";
        file.more = R"(,"materials":[{)" + members + "}]" + more;
        return file;
    }
    Material material(const std::string& members) { return load(with_material(members)).materials[0]; }
    void refuse_material(const std::string& members, const std::vector<std::string>& parts) {
        refuse(with_material(members), parts);
    }
    testing_io::TempFolder folder;
};

}  // namespace hedgerow::testing_gltf
