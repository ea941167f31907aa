#include "control/recording/analysis/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace plab::analysis
{
namespace
{

constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;
constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
constexpr std::size_t kMostBytes = std::size_t(0xFFFFFFFF);

std::vector<float> floats_of(const std::vector<Vec3>& points)
{
    std::vector<float> out;
    out.reserve(3 * points.size());
    for (const Vec3& p : points)
        for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(p[k]));
    return out;
}

void append(std::string& out, std::uint32_t value)
{
    for (int k = 0; k < 4; ++k) out += static_cast<char>(value >> (8 * k));
}

}  // namespace

struct GltfFile::Parts
{
    Json json = Json::object(), accessors = Json::array(), views = Json::array(), meshes = Json::array();
};

GltfFile::GltfFile() : parts_(std::make_unique<Parts>()) {}
GltfFile::~GltfFile() = default;
GltfFile::Json& GltfFile::json() { return parts_->json; }

std::size_t GltfFile::add_view(const void* data, std::size_t bytes, int target)
{
    Json view{{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}};
    if (target != 0) view["target"] = target;
    parts_->views.push_back(std::move(view));
    buffer_.append(static_cast<const char*>(data), bytes);  // all elements have 4 bytes or a multiple: always aligned
    return parts_->views.size() - 1;
}

std::size_t GltfFile::add_floats(std::span<const float> values, int width, bool bounds)
{
    const std::size_t n = values.size() / std::size_t(width);
    Json accessor{{"bufferView", add_view(values.data(), values.size_bytes(), 0)},
                  {"componentType", kFloat},
                  {"count", n},
                  {"type", kTypes[width - 1]}};
    if (bounds)
    {
        std::vector<float> least(values.begin(), values.begin() + width), most = least;
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            float &l = least[i % std::size_t(width)], &m = most[i % std::size_t(width)];
            l = std::min(l, values[i]), m = std::max(m, values[i]);
        }
        accessor["min"] = least, accessor["max"] = most;
    }
    parts_->accessors.push_back(std::move(accessor));
    return parts_->accessors.size() - 1;
}

std::size_t GltfFile::add_indices(std::span<const std::uint32_t> values)
{
    parts_->accessors.push_back({{"bufferView", add_view(values.data(), values.size_bytes(), kIndices)},
                                 {"componentType", kUnsigned},
                                 {"count", values.size()},
                                 {"type", "SCALAR"}});
    return parts_->accessors.size() - 1;
}

std::size_t GltfFile::add_mesh(const GltfSurface& surface, std::size_t material)
{
    const std::size_t points = add_floats(floats_of(surface.points), 3, true), normals = add_floats(floats_of(surface.normals), 3, false);
    parts_->views[parts_->accessors[points]["bufferView"].get<std::size_t>()]["target"] = kVertices;
    parts_->views[parts_->accessors[normals]["bufferView"].get<std::size_t>()]["target"] = kVertices;
    const std::size_t triangles = add_indices(surface.triangles);
    parts_->meshes.push_back(
        {{"primitives",
          Json::array({{{"attributes", {{"POSITION", points}, {"NORMAL", normals}}}, {"indices", triangles}, {"material", material}}})}});
    return parts_->meshes.size() - 1;
}

Result<void> GltfFile::write(const std::string& path)
{
    // A list must not be empty in this format.
    Json& json = parts_->json;
    if (!buffer_.empty()) json["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    if (!parts_->views.empty()) json["bufferViews"] = parts_->views;
    if (!parts_->accessors.empty()) json["accessors"] = parts_->accessors;
    if (!parts_->meshes.empty()) json["meshes"] = parts_->meshes;
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    if (text.size() + buffer_.size() + 28 > kMostBytes)
        return reason(path + " would be larger than 4 GiB, which the format does not allow");
    std::string head;
    append(head, 0x46546C67), append(head, 2),
        append(head, static_cast<std::uint32_t>(12 + 8 + text.size() + (buffer_.empty() ? 0 : 8 + buffer_.size())));
    append(head, static_cast<std::uint32_t>(text.size())), append(head, 0x4E4F534A);
    std::string binary;
    if (!buffer_.empty()) append(binary, static_cast<std::uint32_t>(buffer_.size())), append(binary, 0x004E4942);
    const std::string part = path + ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file << head << text << binary << buffer_;
        file.flush();
        if (!file) return reason(path + " cannot be written");
    }
    std::error_code error;
    std::filesystem::rename(part, path, error);
    if (error) return reason(path + " cannot be written: " + error.message());
    return {};
}

}  // namespace plab::analysis
