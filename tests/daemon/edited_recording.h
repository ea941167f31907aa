/// A recording's copy in which something is otherwise: for what a reader says of it.
#pragma once

#include <functional>
#include <string>

#include "idl/recording/cdr.h"
#include "idl/recording/records.h"

namespace plab::test
{

struct Edits
{
    /// May change the bytes of a message; false leaves it out.
    std::function<bool(const std::string& topic, recording::Bytes& data)> message;
    std::function<void(recording::Pairs& about)> about;  ///< metadata "plab"
};

/// Copies messages, the blueprint and the metadata "plab".
Result<void> copy_recording(const std::string& from, const std::string& to, const Edits& edits);

/// Changes a sample of type T by `change`, if the topic is its.
template <class T, class Change>
bool edit(const std::string& topic, recording::Bytes& data, Change change)
{
    if (topic != wire::topic_of<T>().name) return false;
    recording::Sample<T> sample;
    recording::Decoder decoder;
    recording::Encoder encoder;
    if (!decoder.decode(data, sample)) return false;
    change(*sample);
    const auto bytes = encoder.encode(*sample);
    if (!bytes) return false;
    data.assign(bytes->begin(), bytes->end());
    return true;
}

/// Of a sample: the text goes, a new one comes.
inline void put_text(char*& text, const std::string& other)
{
    dds_string_free(text);
    text = dds_string_dup(other.c_str());
}

}  // namespace plab::test
