/// The lines of a manifest, one at a time. Its format is documented in manifest.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/type_summary.h"
#include "plab/result.h"

namespace plab::plugins
{

/// Collects the content of the lines. An error contains only a reason; the caller knows the line number.
class ManifestReader
{
public:
    /// One line after the header.
    Result<void> add(std::string_view line);
    /// The result. An error if it does not make a manifest: no plugin, a type twice.
    Result<std::vector<model::TypeSummary>> finish();

private:
    using Cells = std::vector<std::string>;
    Result<void> add_plugin(Cells& cells);
    Result<void> add_type(Cells& cells);
    Result<void> add_role(Cells& cells);
    Result<void> add_field(Cells& cells);

    std::string plugin_;
    std::vector<model::TypeSummary> types_;
};

/// All lines after the header, with the types in their order.
std::string manifest_lines(const std::string& plugin, const std::vector<model::TypeSummary>& types);

}  // namespace plab::plugins
