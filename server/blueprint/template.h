/// <template>: blueprint text that a component keeps, to ask for it later (server/docs/rules.md).
#pragma once

#include "blueprint/xml.h"

namespace plab::blueprint
{

/// A <template> as a whole blueprint in text, in which the elements are on the lines where the author wrote them, so that errors found
/// later name the right line. The grammar of its component is not checked.
Result<std::string> template_text(const XmlElement& element);

}  // namespace plab::blueprint
