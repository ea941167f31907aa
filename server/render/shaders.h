/// The programs of the renderer, as texts of GLSL 3.30.
#pragma once

#include <string>

namespace plab::render
{

std::string solid_vertex_shader();
std::string solid_fragment_shader();
/// Depth only.
std::string shadow_fragment_shader();
/// Planes: the ground's grid and Form::Plane.
std::string plane_vertex_shader();
std::string plane_fragment_shader();
std::string background_vertex_shader();
std::string background_fragment_shader();

}  // namespace plab::render
