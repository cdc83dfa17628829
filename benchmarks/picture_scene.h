/// What the benchmarks of pictures share: their arguments, and scenes with a camera.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <hedgerow/render/camera/presets.h>

#include "scene.h"

namespace hedgerow {

/// [SIZE] [SCENE ...]: the side of the pictures, and what they show.
struct PictureArguments {
    int size;
    std::vector<std::string> scenes;

    /// Without scenes: the dragon, if it is there and wanted, and the generated ones.
    PictureArguments(int count, char** arguments, std::initializer_list<const char*> generated,
                     int default_size = 1024, bool with_dragon = true)
        : size(default_size), scenes(arguments + 1, arguments + count) {
        if (!scenes.empty() && std::atoi(scenes[0].c_str()) > 0) {
            size = std::atoi(scenes[0].c_str());
            scenes.erase(scenes.begin());
        }
        if (!scenes.empty()) return;
        if (with_dragon && std::filesystem::exists("data/dragon.ply.gz"))
            scenes.push_back("data/dragon.ply.gz");
        scenes.insert(scenes.end(), generated.begin(), generated.end());
    }
};

/// A scene, the name of its generator or "file", and its own camera or one for its box.
struct PictureScene {
    TriangleMesh<float> mesh;
    std::string kind;
    Camera camera;

    explicit PictureScene(const std::string& name)
        : mesh(scene(name)), kind(name.starts_with("gen:") ? name.substr(4, name.find(':', 4) - 4) : "file") {
        Box3f box;
        for (const auto& v : mesh.vertices) box.expand(v);
        camera = camera_for(kind).value_or(automatic_camera(box));
    }
};

}  // namespace hedgerow
