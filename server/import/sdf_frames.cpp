#include "import/sdf_frames.h"

namespace plab::import
{
namespace
{

constexpr int kMostFramesInARow = 1000;

}  // namespace

bool SdfFrames::add(const std::string& full, SdfFrame frame)
{
    const TextPosition where = frame.where;
    const std::string element = frame.element;
    if (entries_.emplace(full, Entry{std::move(frame), {}, Entry::Open}).second) return true;
    document_.error(where, element, "there are two frames of this name");
    return false;
}

std::optional<std::string> SdfFrames::find(const std::string& scope, const std::string& name, TextPosition where,
                                           const std::string& element)
{
    if (name == "world" || (name == "__model__" && scope.empty())) return "";
    const std::string full = name == "__model__" ? scope : full_name(scope, name);
    if (entries_.contains(full)) return full;
    document_.error(where, element, "there is no frame '" + name + "'" + (scope.empty() ? "" : " in '" + scope + "'"));
    return {};
}

Pose SdfFrames::in_world(const std::string& full)
{
    if (full.empty()) return {};
    const auto found = entries_.find(full);
    if (found == entries_.end()) return {};
    Entry& entry = found->second;
    if (entry.state == Entry::Done) return entry.X_WF;
    if (entry.state == Entry::Busy) return document_.error(entry.frame.where, entry.frame.element, "its pose depends on itself"), Pose{};
    entry.state = Entry::Busy;
    const SdfFrame& f = entry.frame;
    if (const auto base = find(f.scope, f.relative_to.empty() ? "__model__" : f.relative_to, f.where, f.element))
        entry.X_WF = in_world(*base) * step_to(f, full, 0);
    entry.X_WF.q = normalized(entry.X_WF.q);
    entry.state = Entry::Done;
    return entry.X_WF;
}

Pose SdfFrames::step_to(const SdfFrame& frame, const std::string& full, int depth)
{
    if (frame.placement.empty()) return frame.pose;
    const auto inside = find(full, frame.placement, frame.where, frame.element);
    return inside ? frame.pose * inverse(in_model(*inside, full, depth + 1)) : frame.pose;
}

/// X_MF of a frame inside the model M, from frame to frame until M's own.
Pose SdfFrames::in_model(const std::string& full, const std::string& model, int depth)
{
    if (full == model) return {};
    const auto found = entries_.find(full);
    if (found == entries_.end()) return {};
    const SdfFrame& f = found->second.frame;
    if (depth > kMostFramesInARow) return document_.error(f.where, f.element, "its pose depends on itself"), Pose{};
    const auto base = find(f.scope, f.relative_to.empty() ? "__model__" : f.relative_to, f.where, f.element);
    return base ? in_model(*base, model, depth + 1) * step_to(f, full, depth) : Pose{};
}

std::optional<std::string> SdfFrames::link_of(const std::string& full)
{
    std::string at = full;
    for (int i = 0; i < kMostFramesInARow; ++i)
    {
        const auto found = entries_.find(at);
        if (found == entries_.end()) return "";  // the world
        const SdfFrame& f = found->second.frame;
        if (f.attached_to.empty()) return at;
        const auto next = find(f.is_model ? at : f.scope, f.attached_to, f.where, f.element);
        if (!next) return {};
        at = *next;
    }
    const SdfFrame& f = entries_.find(full)->second.frame;
    document_.error(f.where, f.element, "is attached to itself");
    return {};
}

}  // namespace plab::import
