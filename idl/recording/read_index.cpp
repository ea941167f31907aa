#include "idl/recording/read_index.h"

#include "idl/recording/file_scan.h"

namespace plab::recording
{

Result<FileIndex> read_index(const Source& source, const Limits& limits)
{
    auto start = read_start(source, limits);
    if (!start) return start.errors();
    auto footer = read_footer(source);
    if (!footer) return footer.errors();
    Errors troubles;
    if (*footer && (*footer)->summary_start != 0)
    {
        auto index = read_summary(source, **footer, limits);
        if (index)
        {
            index->header = start->header;
            index->is_closed = true;
            return index;
        }
        troubles = index.errors();
    }
    auto scanned = scan_file(source, start->end, limits);
    if (!scanned) return scanned.errors();
    scanned->header = start->header;
    scanned->troubles.insert(scanned->troubles.begin(), troubles.begin(), troubles.end());
    scanned->is_closed = scanned->is_closed && *footer;
    return scanned;
}

}  // namespace plab::recording
