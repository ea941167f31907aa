/// From XML text to the blueprint tree. The language is described in server/docs/blueprint.md.
#pragma once

#include <string>
#include <string_view>

#include "blueprint/foreign.h"
#include "blueprint/xgl.h"
#include "model/blueprint.h"

namespace plab::blueprint
{

/// The handlers of all foreign elements: <MESH> and <template>.
ForeignHandlers standard_handlers();

/// Reads a whole scene (<plab>) or a fragment for a request (<plab> or a single <component>). Collects errors as long as the
/// XML is well-formed; their places name `file_name`. Never throws, whatever `text` contains.
Result<model::Blueprint> read_blueprint(std::string_view text, const std::string& file_name,
                                        const ForeignHandlers& handlers = standard_handlers(), const XmlLimits& limits = {});

Result<model::Blueprint> read_blueprint_file(const std::string& path, const ForeignHandlers& handlers = standard_handlers(),
                                             const XmlLimits& limits = {});

}  // namespace plab::blueprint
