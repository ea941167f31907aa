#include "exclude.h"

namespace plab::detection
{

void ExcludeRows::describe(Schema& s)
{
    const std::vector<Facet> facets{Facet::Body, Facet::Shape};
    s.role(within, "within", facets, "no two of these collide; a body stands for all its shapes").optional().independent();
    s.role(a, "a", facets, "none of these collides with one of `b`").optional().independent();
    s.role(b, "b", facets, "see `a`").optional().independent();
}

Result<void> prepare_exclude(Row row, const ExcludeRows& rows)
{
    if (rows.a[row].empty() != rows.b[row].empty()) return reason("a and b belong together: none of a collides with one of b");
    if (rows.within[row].empty() && rows.a[row].empty()) return reason("excludes nothing: give within, or a and b");
    return {};
}

void connect_exclude(Row row, const ExcludeRows& rows, CollisionFilter& filter)
{
    if (!rows.within[row].empty()) filter.exclude_within(rows.within[row]);
    if (!rows.a[row].empty()) filter.exclude_between(rows.a[row], rows.b[row]);
}

}  // namespace plab::detection
