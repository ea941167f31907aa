/// One topic of a recording on the bus: bytes in, samples out, with the numbers that they have in this playback.
#pragma once

#include <memory>
#include <string>

#include "idl/entity.h"
#include "idl/recording/records.h"

namespace plab::playback
{

/// What is another in the playback than in the recording.
struct Changes
{
    std::string server;           ///< name
    std::uint64_t run_shift = 0;  ///< runs of the recording count on from here: each jump back is a new run
};

class Track
{
public:
    virtual ~Track() = default;

    /// An error: the bytes are no sample of the topic, or DDS would not take it.
    virtual Result<void> send(recording::ByteView bytes, const Changes& changes) = 0;
    /// Takes notice of a sample that is not sent: what is sent next may refer to it.
    virtual void skip(recording::ByteView bytes) = 0;
    /// The instance of this key is gone.
    virtual void dispose(const std::string& key) = 0;
    virtual wire::Matched readers() const = 0;
    /// Until readers have all that was sent, for so long at the most.
    virtual void flush(dds_duration_t longest) = 0;

    /// The next sample does not follow the last one in the recording; its number does all the same.
    void jump() { jumped_ = true, forget(); }
    /// What numbers of the recording are more here (modulo 2^64).
    std::uint64_t number_shift() const { return shift_; }

protected:
    virtual void forget() = 0;
    /// The number of a sample with so many entries.
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

/// `topic` is one that a server writes, plab/server and plab/replies excepted. `moved_only`: frames have to be made whole.
Result<std::unique_ptr<Track>> make_track(const wire::Topic& topic, const wire::Entity& participant, const wire::Entity& publisher,
                                          bool moved_only);

/// Whether a recording of this topic can be sent: not what clients say, nor what answers them.
bool is_played(const wire::Topic& topic);

}  // namespace plab::playback
