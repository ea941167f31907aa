/// From a compiled scene back to text, and from the types' declarations to their manual.
#pragma once

#include <string>

#include "model/scene.h"
#include "model/type_registry.h"

namespace plab::blueprint
{

/// The long form of a scene: every component written out, generated ones too, every given field as a <param> (17 significant
/// digits where needed), and for each top-level component a simulation command that names all commands that take part. Reading
/// and compiling it gives the same scene.
std::string write_long_form(const model::SceneSpec& scene, model::TypeSource& types);

/// The reference manual of all types that `types` knows, in Markdown, by kind and name. A type that cannot be loaded is listed
/// with the reason.
std::string write_reference(model::TypeSource& types);
/// The manual of one type, whose name may be shortened ("Rows"), or of all types whose names begin with `which` ("Response").
Result<std::string> write_reference(model::TypeSource& types, const std::string& which);

/// Escapes text for XML; characters that XML cannot represent become U+FFFD.
std::string escape_text(std::string_view text);
std::string escape_attribute(std::string_view text);

}  // namespace plab::blueprint
