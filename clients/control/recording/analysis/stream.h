/// The messages of a recording in order of time, decoded.
///
///   Stream stream(reader, {.topics = {"plab/states"}});
///   while (const Entry* entry = stream.next())
///       if (const auto* frame = entry->as<plab_v2_Frame>()) use(*frame);
///
/// Memory: what the reader holds open, and one sample of each type.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "idl/recording/reader.h"
#include "idl/recording/whole_frame.h"
#include "idl/topics.h"

namespace plab::analysis
{

/// The sample, of one of our topics; empty for foreign topics or another version of the wire.
using Content =
    std::variant<std::monostate, const plab_v2_Server*, const plab_v2_Scene*, const plab_v2_SceneObject*, const plab_v2_Shape*,
                 const plab_v2_Interaction*, const plab_v2_Type*, const plab_v2_Frame*, const plab_v2_Collisions*, const plab_v2_Events*,
                 const plab_v2_Metrics*, const plab_v2_Request*, const plab_v2_Reply*, const plab_v2_Image*, const plab_v2_Journal*,
                 const plab_v2_Hashes*, const plab_v2_Snapshot*, const plab_v2_Gone*>;

/// One message; valid until the stream advances.
struct Entry
{
    const recording::Channel* channel = nullptr;
    std::uint64_t log_time = 0;      ///< ns, of the recording
    std::uint64_t publish_time = 0;  ///< ns since 1970
    recording::ByteView data;
    Content content;

    template <class T>
    const T* as() const
    {
        const auto* held = std::get_if<const T*>(&content);
        return held == nullptr ? nullptr : *held;
    }
};

/// What could not be read: damaged chunks, invalid samples.
struct Troubles
{
    static constexpr std::size_t kMostTexts = 16;

    std::uint64_t count = 0;
    std::vector<std::string> texts;  ///< of the first ones

    void add(const std::string& text);
    /// Merges those of another pass over the same file: what both have seen counts once.
    void merge(const Troubles& other);
};

class Stream
{
public:
    /// The reader must outlive the stream and must not move.
    Stream(const recording::McapReader& reader, const recording::Query& query);
    ~Stream();
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) = delete;

    /// Null at the end. Damaged messages are skipped, and counted among the troubles.
    const Entry* next();
    const Troubles& troubles() const { return troubles_; }

private:
    struct Samples;
    using Decode = Result<Content> (*)(Samples&, recording::ByteView);
    template <class T>
    static Result<Content> decode(Samples& samples, recording::ByteView bytes);
    template <class T>
    static void enter(std::map<std::string_view, Decode>& table);
    static const std::map<std::string_view, Decode>& table();
    Decode decode_for(const recording::Channel& channel);

    const recording::McapReader* reader_;
    recording::Cursor cursor_;
    std::unique_ptr<Samples> samples_;
    std::map<recording::ChannelId, Decode> decodes_;
    Entry entry_;
    Troubles troubles_;
};

/// The state of all objects: completed frames (idl/recording/whole_frame.h) with lookup by handle.
class Merged
{
public:
    /// The next frame; it may contain only what moved.
    void note(const plab_v2_Frame& frame);

    /// Valid until the next frame is noted.
    const plab_v2_Frame& now() const { return *now_; }
    std::span<const plab_v2_BodyState> bodies() const { return {now_->bodies._buffer, now_->bodies._length}; }
    std::span<const plab_v2_ShaftState> shafts() const { return {now_->shafts._buffer, now_->shafts._length}; }
    /// Null: no frame of this run and revision contains it.
    const plab_v2_BodyState* find_body(std::uint32_t handle) const;
    const plab_v2_ShaftState* find_shaft(std::uint32_t handle) const;

private:
    using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // handle, place in the frame; sorted

    recording::WholeFrame whole_;
    const plab_v2_Frame* now_ = nullptr;
    Places bodies_, shafts_;
    std::uint64_t run_ = 0, revision_ = 0;  ///< to which the places belong
};

}  // namespace plab::analysis
