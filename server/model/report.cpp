#include <algorithm>

#include "model/compile_internal.h"
#include "model/names.h"

namespace plab::model::detail
{

namespace
{

/// Number of errors that are kept; the rest are only counted, so that a hostile file costs no memory.
constexpr std::size_t kMostKept = 20'000;

bool precedes(const SourceLocation& a, const SourceLocation& b)
{
    if ((a.line == 0) != (b.line == 0)) return b.line == 0;  // errors without a place come last
    if (a.file != b.file) return a.file < b.file;
    return a.line != b.line ? a.line < b.line : a.column < b.column;
}

}  // namespace

void Report::add(Error error, std::string wanted)
{
    if (complaints_.size() >= std::max(kMostKept, most_))
    {
        ++dropped_;
        return;
    }
    std::string key = std::to_string(error.where.line) + ":" + std::to_string(error.where.column) + ":" + error.reason;
    if (error.where.line == 0) key += ":" + error.element;
    if (seen_.insert(std::move(key)).second) complaints_.push_back({std::move(error), std::move(wanted)});
}

Errors Report::finish(const std::vector<std::string>& ids, const std::string& file)
{
    std::stable_sort(complaints_.begin(), complaints_.end(),
                     [](const Complaint& a, const Complaint& b) { return precedes(a.error.where, b.error.where); });
    Errors out;
    for (Complaint& complaint : complaints_)
    {
        if (out.size() == std::max<std::size_t>(most_, 1)) break;
        if (!complaint.wanted_id.empty()) complaint.error.reason += did_you_mean(complaint.wanted_id, ids);
        out.push_back(std::move(complaint.error));
    }
    const std::size_t more = complaints_.size() - out.size() + dropped_;
    if (more > 0) out.push_back({{file, 0, 0}, {}, "... and " + std::to_string(more) + " more"});
    return out;
}

}  // namespace plab::model::detail
