/// Properties of a scene that several closed forms need.
#pragma once

#include "exact/closed_form.h"
#include "model/numbers.h"

namespace plab::exact
{

/// A number as shown in names and messages of references.
inline std::string real(double v) { return model::format_real(v); }

/// The current state of a body or a shaft.
State present(const SceneFacts& facts, std::uint32_t component);
/// The only moving object, a body or a shaft; directory index.
Result<std::uint32_t> only_object(const SceneFacts& facts);
/// The participants in a role of a component; directory indices.
std::vector<std::uint32_t> participants(const SceneFacts& facts, std::uint32_t component, const std::string& role);
/// A field of a component; 0 if it has none of that kind.
double real_of(const SceneFacts& facts, std::uint32_t component, const std::string& field);
Vec3 vector_of(const SceneFacts& facts, std::uint32_t component, const std::string& field);
Error missing_number(const std::string& name, const std::string& what);

/// The only moving body, and the plane that it can hit: a point on it and its normal in W.
struct OnPlane
{
    std::uint32_t body = 0, plane = 0;  ///< directory indices
    Vec3 point, normal;
};
Result<OnPlane> body_and_plane(const SceneFacts& facts);
/// The shape of a body that has one, of this kind.
Result<Geometry> only_shape(const SceneFacts& facts, std::uint32_t body, GeometryKind kind, const std::string& name);
/// Friction or restitution of the only response; materials are not considered.
Result<double> law_of(const SceneFacts& facts, const std::string& name);

}  // namespace plab::exact
