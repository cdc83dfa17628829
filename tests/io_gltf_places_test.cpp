/// What nodes of glTF place in a model: instances, cameras and lights; and extensions that a file requires.
#include "gltf_models.h"

namespace hedgerow {
namespace {

using namespace testing_gltf;
using namespace testing_io;

class GltfPlaces : public GltfModelTest {};

TEST_F(GltfPlaces, InstancesStayInstances) {
    Gltf file = triangle();
    file.roots = "0,1,2,3";
    file.nodes = R"({"mesh":0,"name":"a"},{"mesh":0,"translation":[5,0,0],"scale":[-2,1,1]},)"
                 R"({"mesh":0,"name":"flat","scale":[1,1,0],"translation":[0,0,3]},{"name":"nothing"})";
    const auto model = load(file);
    ASSERT_EQ(model.instances.size(), 3u);
    EXPECT_EQ(model.instances[0].object, 0u);
    EXPECT_EQ(model.instances[0].name, "a");
    EXPECT_EQ(model.instances[1].object, 0u);
    EXPECT_TRUE(model.instances[1].mirrors());
    EXPECT_EQ(model.objects.size(), 2u) << "what has no inverse is written out";
    EXPECT_EQ(model.instances[2].object, 1u);
    EXPECT_EQ(model.instances[2].to_world, Transform<3>());
    EXPECT_EQ(corners_of(model), corners_of(load_mesh(folder / "a.gltf")));
}

TEST_F(GltfPlaces, Cameras) {
    Gltf file = triangle();
    file.roots = "0,1,2";
    file.nodes = R"({"mesh":0},{"camera":0,"translation":[1,2,3]},{"camera":1,"name":"node"})";
    file.more =
        R"(,"cameras":[{"type":"perspective","name":"eye","perspective":{"yfov":0.5,"aspectRatio":1.5,)"
        R"("znear":0.1}},{"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"zfar":9,"znear":1}}])";
    const auto model = load(file);
    ASSERT_EQ(model.cameras.size(), 2u);
    EXPECT_EQ(model.cameras[0].name, "eye");
    EXPECT_EQ(std::get<PerspectiveView>(model.cameras[0].view).field_of_view, 0.5);
    EXPECT_EQ(model.cameras[0].aspect, 1.5);
    EXPECT_EQ(model.cameras[0].to_world.shift, Vec3d(1, 2, 3));
    EXPECT_EQ(model.cameras[1].name, "node");
    EXPECT_EQ(std::get<OrthographicView>(model.cameras[1].view).height, 4);
    EXPECT_EQ(model.cameras[1].aspect, 1.5);
    const auto bad = [&](const std::string& camera, const std::vector<std::string>& parts) {
        file.more = R"(,"cameras":[)" + camera + "]";
        refuse(file, parts);
    };
    bad(R"({"type":"perspective","perspective":{"yfov":0}})", {"'yfov' is 0"});
    bad(R"({"type":"perspective","perspective":{"yfov":3.2}})", {"'yfov' is 3.2"});
    bad(R"({"type":"perspective"})", {"camera 0 has no 'perspective'"});
    bad(R"({"type":"orthographic","orthographic":{"xmag":1}})", {"'ymag' is missing"});
    bad(R"({"type":"fisheye"})", {"camera 0 is neither"});
    bad("", {"number 0 of its cameras"});
}

std::string light_node(int i) {
    return R"({"extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(i) +
           R"(}},"rotation":[0,0.7071067811865476,0,0.7071067811865476],"translation":[1,2,3]})";
}

TEST_F(GltfPlaces, Lights) {
    Gltf file = triangle();
    file.roots = "0,1,2,3";
    file.nodes = R"({"mesh":0},)" + light_node(0) + "," + light_node(1) + "," + light_node(2);
    const auto with = [&](const std::string& lights) {
        file.more = R"(,"extensions":{"KHR_lights_punctual":{"lights":[)" + lights + "]}}";
        return file;
    };
    const auto model = load(with(
        R"({"type":"point","name":"lamp","color":[1,0.5,0],"intensity":10,"range":5},)"
        R"({"type":"directional","intensity":3},{"type":"spot","spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}})"));
    ASSERT_EQ(model.lights.size(), 3u);
    const auto& point = std::get<PointLight>(model.lights[0]);
    EXPECT_EQ(point.name, "lamp");
    EXPECT_EQ(point.position, Vec3d(1, 2, 3));
    EXPECT_EQ(point.intensity, Vec3f(10, 5, 0));
    const auto& sun = std::get<DirectionalLight>(model.lights[1]);
    EXPECT_EQ(sun.illuminance, Vec3f(3, 3, 3));
    EXPECT_NEAR(length(sun.direction - Vec3d(-1, 0, 0)), 0, 1e-12) << "-z, turned a quarter about y";
    const auto& spot = std::get<SpotLight>(model.lights[2]);
    EXPECT_EQ(spot.inner, 0.25);
    EXPECT_EQ(spot.outer, 0.5);
    EXPECT_EQ(spot.intensity, Vec3f(1, 1, 1));
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"range of lights (KHR_lights_punctual)"}));

    const std::string ok = R"({"type":"point"})";
    refuse(with(ok), {"a node has light 1, which is not there"});
    refuse(with(ok + "," + ok + R"(,{"type":"area"})"), {"light 2 is neither"});
    refuse(with(ok + "," + ok + R"(,{"type":"point","intensity":-1})"), {"light 2 is negative"});
    refuse(with(ok + "," + ok + R"(,{"type":"spot","spot":{"outerConeAngle":2}})"), {"angles of light 2"});
    refuse(with(ok + "," + ok + R"(,{"type":"spot","spot":{"innerConeAngle":0.9}})"), {"angles of light 2"});
}

TEST_F(GltfPlaces, ExtensionsThatAreRequired) {
    Gltf file = triangle();
    file.more = R"(,"extensionsUsed":["KHR_materials_sheen","EXT_lights_image_based"],)"
                R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"])";
    EXPECT_EQ(load(file).not_shown, (std::vector<std::string>{"EXT_lights_image_based"}))
        << "extensions of materials are named where a material has them";
    for (const std::string name : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_new"}) {
        file.more = R"(,"extensionsRequired":[")" + name + "\"]";
        refuse(file, {"requires the extension '" + name + "'"});
    }
}

}  // namespace
}  // namespace hedgerow
