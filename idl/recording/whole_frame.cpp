#include "idl/recording/whole_frame.h"

#include <algorithm>

namespace plab::recording
{
namespace
{

/// Rows of `news` replace those with the same handles. Both are mostly in the same order: one pass.
template <class Row, class Sequence>
void merge(std::vector<Row>& kept, const Sequence& news)
{
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < news._length; ++i)
    {
        const Row& row = news._buffer[i];
        const auto is_it = [&](const Row& other) { return other.handle == row.handle; };
        auto found = std::find_if(kept.begin() + static_cast<std::ptrdiff_t>(at), kept.end(), is_it);
        if (found == kept.end()) found = std::find_if(kept.begin(), kept.end(), is_it);
        if (found == kept.end()) found = kept.insert(kept.end(), row);
        *found = row;
        at = static_cast<std::size_t>(found - kept.begin()) + 1;
    }
}

template <class Sequence, class Row>
void show(Sequence& out, std::vector<Row>& rows)
{
    const auto count = static_cast<std::uint32_t>(rows.size());
    out._maximum = out._length = count;
    out._buffer = rows.data(), out._release = false;
}

}  // namespace

const plab_v2_Frame& WholeFrame::with(const plab_v2_Frame& frame)
{
    if (frame.run != run_ || frame.revision != revision_) bodies_.clear(), shafts_.clear();
    run_ = frame.run, revision_ = frame.revision;
    merge(bodies_, frame.bodies);
    merge(shafts_, frame.shafts);
    out_ = frame;
    show(out_.bodies, bodies_);
    show(out_.shafts, shafts_);
    return out_;
}

}  // namespace plab::recording
