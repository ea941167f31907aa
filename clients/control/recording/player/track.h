/// One topic of a recording on the bus: takes bytes, publishes samples with the numbers of this playback.
#pragma once

#include <memory>
#include <string>

#include "idl/entity.h"
#include "idl/recording/records.h"

namespace plab::player
{

/// Values that differ between the playback and the recording.
struct Changes
{
    std::string server;           ///< name
    std::uint64_t run_shift = 0;  ///< runs of the recording are numbered from here: each jump back is a new run
};

class Track
{
public:
    virtual ~Track() = default;

    /// An error: the bytes are not a sample of the topic, or DDS refused it.
    virtual Result<void> send(recording::ByteView bytes, const Changes& changes) = 0;
    /// Takes note of a sample that is not sent, since later samples may refer to it.
    virtual void skip(recording::ByteView bytes) = 0;
    /// The instance of this key no longer exists.
    virtual void dispose(const std::string& key) = 0;
    virtual wire::Matched readers() const = 0;
    /// Waits until readers have everything that was sent, at most this long.
    virtual void flush(dds_duration_t longest) = 0;

    /// The next sample does not follow the last one in the recording, but its number continues.
    void jump() { jumped_ = true, forget(); }
    /// Offset from the recording's numbers to the published ones (modulo 2^64).
    std::uint64_t number_shift() const { return shift_; }

protected:
    virtual void forget() = 0;
    /// The number of a sample with this many entries.
    std::uint64_t renumbered(std::uint64_t first, std::uint64_t entries)
    {
        if (jumped_ && next_ > 0) shift_ = next_ - first;
        jumped_ = false;
        next_ = first + shift_ + entries;
        return first + shift_;
    }

private:
    bool jumped_ = false;
    std::uint64_t next_ = 0, shift_ = 0;  ///< next_: 0 before the first sample
};

/// `topic` is one that a server writes, except plab/server and plab/replies. `moved_only`: frames have to be completed.
Result<std::unique_ptr<Track>> make_track(const wire::Topic& topic, const wire::Entity& participant, const wire::Entity& publisher,
                                          bool moved_only);

/// Whether a recording of this topic can be sent: neither requests of clients nor replies to them.
bool is_played(const wire::Topic& topic);

}  // namespace plab::player
