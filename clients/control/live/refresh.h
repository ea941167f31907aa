/// Commands that print the same figures again and again, as `levels --live` and `top` do.
#pragma once

#include <functional>

#include "control/command/context.h"
#include "link/catalogue.h"

namespace plab::cli
{

/// Calls `print` at once and then every `every` seconds, with what the catalogue has by then; without `again` only once. Ends by -n, by -d,
/// by Ctrl-C, when nobody reads the output any more, or when the server ends, each with its exit code.
Exit print_again(const Context& context, link::Catalogue& catalogue, link::Seconds every, bool again,
                 const std::function<void(const link::CatalogueContents&)>& print);

}  // namespace plab::cli
