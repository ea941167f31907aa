// Recordings as glTF, read back by Assimp.
#include <assimp/scene.h>
#include <doctest/doctest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>

#include "control/recording/analysis/gltf.h"
#include "made_recording.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

/// Where the film of this recording is.
std::string film_of(const std::string& file, const GltfOptions& wanted, Exported* done = nullptr)
{
    auto log = Log::open(file);
    REQUIRE(log.ok());
    GltfOptions options = wanted;
    options.out = fresh_path("film.glb");
    const auto made = export_gltf(*log, options);
    REQUIRE_MESSAGE(made.ok(), made.error().text());
    if (done != nullptr) *done = *made;
    return options.out;
}

const aiScene* read_back(Assimp::Importer& importer, const std::string& film)
{
    const aiScene* const scene = importer.ReadFile(film, 0);
    REQUIRE_MESSAGE(scene != nullptr, importer.GetErrorString());
    return scene;
}

const aiNodeAnim* channel_of(const aiScene& scene, const char* node)
{
    REQUIRE(scene.mNumAnimations == 1);
    const aiAnimation& animation = *scene.mAnimations[0];
    for (unsigned i = 0; i < animation.mNumChannels; ++i)
        if (std::strcmp(animation.mChannels[i]->mNodeName.C_Str(), node) == 0) return animation.mChannels[i];
    return nullptr;
}

}  // namespace

TEST_CASE("bodies and shafts are where the recording has them, at each key frame")
{
    Assimp::Importer importer;
    const aiScene& scene = *read_back(importer, film_of(make_recording("film.mcap", {.only_moved = true}), {.every = 0}));
    const aiNodeAnim* const red = channel_of(scene, "red");
    REQUIRE(red != nullptr);
    REQUIRE(red->mNumPositionKeys == 201);
    for (unsigned k = 0; k < red->mNumPositionKeys; ++k)
    {
        const double t = k * kMadeStep;
        const MadePlace place = made_red(t);
        CHECK(std::fabs(red->mPositionKeys[k].mTime / scene.mAnimations[0]->mTicksPerSecond - t) < 1e-6);
        CHECK(std::fabs(double(red->mPositionKeys[k].mValue.x) - place.x) < 1e-6);
        CHECK(std::fabs(double(red->mPositionKeys[k].mValue.y) - place.y) < 1e-6);
        CHECK(std::fabs(double(red->mPositionKeys[k].mValue.z) - place.z) < 1e-6);
        const aiQuaternion& q = red->mRotationKeys[k].mValue;
        CHECK(std::fabs(std::fabs(std::cos(t) * double(q.w) + std::sin(t) * double(q.z)) - 1) < 1e-6);
    }
    CHECK(channel_of(scene, "blue") != nullptr);
    CHECK(channel_of(scene, "axle") == nullptr);  // it never moves in this recording
}

TEST_CASE("key frames keep their distance; shafts that turn too far between them are told of")
{
    Assimp::Importer importer;
    Exported done;
    const aiScene& scene = *read_back(importer, film_of(make_recording("film_rare.mcap"), {.span = {0.5, 1.5}, .every = 0.1}, &done));
    CHECK(channel_of(scene, "red")->mNumPositionKeys == 11);
    CHECK(channel_of(scene, "axle")->mNumRotationKeys == 11);
    CHECK(done.troubles.count == 0);
    film_of(make_recording("film_rarer.mcap"), {.every = 1.5}, &done);
    CHECK(done.troubles.count == 1);
}

TEST_CASE("the first run of the span is exported; a span without states is refused")
{
    Assimp::Importer importer;
    const std::string file = make_recording("film_runs.mcap", {.steps_after = 20});
    CHECK(channel_of(*read_back(importer, film_of(file, {.every = 0})), "red")->mNumPositionKeys == 201);
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const auto refused = export_gltf(*log, {.span = {100, 101}, .out = fresh_path("none.glb")});
    REQUIRE(!refused.ok());
    CHECK(refused.error().text().find("has no states between --from and --to") != std::string::npos);
}

TEST_CASE("a file that cannot be written is an error")
{
    const std::string file = make_recording("film_options.mcap");
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const auto refused = export_gltf(*log, {.out = "/no/such/folder/film.glb"});
    REQUIRE(!refused.ok());
    CHECK(refused.error().text().find("cannot be written") != std::string::npos);
}
