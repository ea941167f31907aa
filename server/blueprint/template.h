/// <template>: blueprint text that a component keeps, to ask for it later (server/docs/rules.md).
#pragma once

#include "blueprint/foreign.h"

namespace plab::blueprint
{

/// One value, "template": a whole blueprint as text, in which the elements are on the lines where the author wrote them, so that errors
/// found later name the right line. The grammar is checked here; ids and values that contain ${...} are not.
Result<std::vector<model::ValueNode>> read_template(const XmlElement& element);

/// The <template> element that read_template() reads back, indented by `indent` spaces; empty if the text is no blueprint.
std::string write_template(const std::string& text, std::size_t indent);

/// The handlers of all foreign elements: <MESH> and <template>.
ForeignHandlers standard_handlers();

}  // namespace plab::blueprint
