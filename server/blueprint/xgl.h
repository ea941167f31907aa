/// XGL meshes inside blueprints (XGL File Format Specification 1.0: MESH, P, N, TC, F, FV1..FV3, PATCH).
#pragma once

#include "blueprint/foreign.h"

namespace plab::blueprint
{

/// <MESH> as two values: "vertices" (flat x y z, in m) and "triangles" (index triples from 0, order of the file).
/// Colours, normals and texture coordinates are accepted and not kept: pLab draws flat shades.
Result<std::vector<model::ValueNode>> read_xgl_mesh(const XmlElement& mesh);

/// The handler of <MESH>; a component that holds one and states no type is a Shape/Mesh.
ForeignHandlers xgl_handlers();

/// The <MESH> element that read_xgl_mesh() reads back as the same numbers, indented by `indent` spaces.
std::string write_xgl_mesh(const Reals& vertices, const Integers& triangles, std::size_t indent);

/// Whether the lists can be written as a mesh: complete points and triangles, every index is valid, and no triangle uses a
/// point twice.
bool is_xgl_mesh(const Reals& vertices, const Integers& triangles);

}  // namespace plab::blueprint
