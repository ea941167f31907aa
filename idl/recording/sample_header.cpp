#include "idl/recording/sample_header.h"

#include <cstring>

#include "idl/recording/cdr.h"

namespace plab::recording
{
namespace
{

std::string text(const char* s) { return s == nullptr ? "" : s; }

SampleHeader header(const plab_v2_Server& s)
{
    SampleHeader out;
    out.run = s.run, out.time = s.time, out.step = s.step, out.key = text(s.name), out.started_ns = s.started_ns;
    return out;
}

/// The time of the first entry; a sample contains the entries of one step.
template <class T>
SampleHeader header_with_entries(const T& sample)
{
    SampleHeader out;
    out.run = sample.run, out.step = sample.step, out.first = sample.sequence_number, out.entries = sample.entries._length;
    if (sample.entries._length > 0) out.time = sample.entries._buffer[0].time;
    return out;
}
SampleHeader header(const plab_v2_Collisions& c) { return header_with_entries(c); }
SampleHeader header(const plab_v2_Events& e) { return header_with_entries(e); }

template <class T>
SampleHeader header_with_time(const T& sample)
{
    SampleHeader out;
    out.run = sample.run, out.time = sample.time, out.step = sample.step;
    return out;
}
SampleHeader header(const plab_v2_Metrics& m) { return header_with_time(m); }
SampleHeader header(const plab_v2_Reply& r) { return header_with_time(r); }
template <class T>
SampleHeader header_of_frame(const T& f)
{
    SampleHeader out = header_with_time(f);
    out.stamp_ns = f.stamp_ns, out.first = f.sequence_number, out.entries = 1;
    return out;
}
SampleHeader header(const plab_v2_Frame& f) { return header_of_frame(f); }
SampleHeader header(const plab_v2_FrameUpdate& f) { return header_of_frame(f); }
SampleHeader header(const plab_v2_Image& i)
{
    SampleHeader out = header_with_time(i);
    out.key = text(i.camera);
    return out;
}
/// Of samples that count one each.
template <class T>
SampleHeader header_of_numbered(const T& sample)
{
    SampleHeader out = header_with_time(sample);
    out.first = sample.sequence_number, out.entries = 1;
    return out;
}
SampleHeader header(const plab_v2_Journal& j) { return header_of_numbered(j); }
SampleHeader header(const plab_v2_Forces& f) { return header_of_numbered(f); }
SampleHeader header(const plab_v2_ContactForces& c) { return header_of_numbered(c); }
SampleHeader header(const plab_v2_Snapshot& s)
{
    SampleHeader out = header_with_time(s);
    out.blueprint = text(s.blueprint);
    return out;
}

SampleHeader header(const plab_v2_Hashes& h)
{
    SampleHeader out;
    out.run = h.run, out.step = h.step, out.first = h.sequence_number, out.entries = h.values._length;
    return out;
}

template <class T>
SampleHeader header_of_instance(const T& sample, const char* key)
{
    SampleHeader out;
    out.run = sample.run, out.key = text(key);
    return out;
}
SampleHeader header(const plab_v2_Scene& s) { return header_of_instance(s, s.server_name); }
SampleHeader header(const plab_v2_SceneObject& o) { return header_of_instance(o, o.component_id); }
SampleHeader header(const plab_v2_Interaction& i)
{
    SampleHeader out = header_of_instance(i, i.component_id);
    out.step = i.since;
    return out;
}
SampleHeader header(const plab_v2_Gone& g) { return header_of_instance(g, g.component_id); }

SampleHeader header(const plab_v2_Shape& s)
{
    SampleHeader out;
    out.key = text(s.component_id);
    return out;
}
SampleHeader header(const plab_v2_Type& t)
{
    SampleHeader out;
    out.key = text(t.type_name);
    return out;
}
SampleHeader header(const plab_v2_Request&) { return {}; }
template <class T>
SampleHeader header_of_person(const T& s)
{
    SampleHeader out;
    out.stamp_ns = s.stamp_ns;
    return out;
}
SampleHeader header(const plab_v2_ViewerSample& s) { return header_of_person(s); }
SampleHeader header(const plab_v2_UserSample& s) { return header_of_person(s); }

template <class T>
class PeekOf final : public Peek
{
public:
    Result<SampleHeader> at(ByteView bytes) override
    {
        if (auto decoded = decoder_.decode(bytes, sample_); !decoded) return decoded.errors();
        return header(*sample_);
    }

private:
    Decoder decoder_;
    Sample<T> sample_;
};

/// The type among Ts that this topic has.
template <class... Ts>
std::unique_ptr<Peek> make_one_of(const wire::Topic& topic)
{
    std::unique_ptr<Peek> out;
    (void)((std::strcmp(wire::topic_of<Ts>().name, topic.name) == 0 && (out = std::make_unique<PeekOf<Ts>>(), true)) || ...);
    return out;
}

}  // namespace

std::unique_ptr<Peek> make_peek(const wire::Topic& topic)
{
    return make_one_of<plab_v2_Server, plab_v2_Scene, plab_v2_SceneObject, plab_v2_Shape, plab_v2_Interaction, plab_v2_Type, plab_v2_Frame,
                       plab_v2_FrameUpdate, plab_v2_Collisions, plab_v2_Events, plab_v2_Metrics, plab_v2_Request, plab_v2_Reply,
                       plab_v2_Image, plab_v2_Journal, plab_v2_Hashes, plab_v2_Snapshot, plab_v2_Gone, plab_v2_ViewerSample,
                       plab_v2_UserSample, plab_v2_Forces, plab_v2_ContactForces>(topic);
}

std::string key_of_gone(ByteView bytes)
{
    constexpr std::size_t kHead = 4 + 4;  // encapsulation, and the length with the terminating zero
    if (bytes.size() <= kHead) return {};
    const bool is_little = (bytes[1] & 1u) != 0;
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length |= std::uint32_t{bytes[4 + i]} << (8 * (is_little ? i : 3 - i));
    if (length == 0 || length > bytes.size() - kHead || bytes[kHead + length - 1] != 0) return {};
    return {reinterpret_cast<const char*>(bytes.data() + kHead), length - 1};
}

}  // namespace plab::recording
