/// A binary glTF 2.0 file (.glb) while it is put together: numbers in one buffer, and the JSON that says what they are.
///
/// Source: Khronos, glTF 2.0 specification (2021): accessors in 3.6, animations in 3.11, the container in 4.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "control/recording/analysis/gltf_forms.h"
#include "plab/result.h"

namespace plab::analysis
{

class GltfFile
{
public:
    using Json = nlohmann::ordered_json;

    GltfFile();
    ~GltfFile();
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    /// Numbers of accessors. `width`: floats in each element, 1 to 4; `bounds`: state the least and largest, as positions and times must.
    std::size_t add_floats(std::span<const float> values, int width, bool bounds);
    std::size_t add_indices(std::span<const std::uint32_t> values);
    /// The number of a mesh.
    std::size_t add_mesh(const GltfSurface& surface, std::size_t material);

    /// Everything but accessors, buffers and meshes: asset, scenes, nodes, materials, animations.
    Json& json();
    /// The file. Errors: it cannot be written, or is larger than the format allows (4 GiB).
    Result<void> write(const std::string& path);

private:
    std::size_t add_view(const void* data, std::size_t bytes, int target);

    struct Parts;
    std::string buffer_;
    std::unique_ptr<Parts> parts_;
};

}  // namespace plab::analysis
