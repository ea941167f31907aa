/// The samples of users or viewers on their way to plabd: the newest one of each instance, at most at a fixed rate.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include "bus/channel/messages.h"
#include "bus/process/trouble.h"
#include "idl/entity.h"
#include "idl/samples.h"

namespace plab::bus
{

/// T: type on the wire. Sample: its value.
template <class T, class Sample>
class NewestSamples
{
public:
    using Clock = std::chrono::steady_clock;
    /// An instance is passed on at most this often: more would be no use to steps, and a flood must not fill the pipe.
    static constexpr std::chrono::microseconds kShortest{500};
    static constexpr std::size_t kMost = 64;  ///< instances; the samples of others are dropped

    explicit NewestSamples(Up kind) : kind_(kind) {}

    Result<void> open(const wire::Entity& participant, const wire::Entity& subscriber)
    {
        auto reader = wire::DataReader<T>::make(participant, subscriber);
        if (!reader) return reader.errors();
        reader_ = reader.take();
        return {};
    }
    /// Takes what has arrived. True if there may be more.
    bool read(Trouble& trouble)
    {
        const auto handle = [this](const T& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data)
                keep(sample, false);
            else if (info.instance_state != DDS_IST_ALIVE)
                keep(sample, true);
        };
        const dds_return_t n = reader_.take(handle, 1);
        (void)trouble.check(wire::topic_of<T>().name, n < 0 ? n : DDS_RETCODE_OK);
        return n > 0;
    }
    /// Passes on what is due. Returns the time until something else is.
    Clock::duration pass_on(MessageWriter& to, Clock::time_point now)
    {
        Clock::duration next = Clock::duration::max();
        for (Instance& i : instances_)
        {
            if (!i.waits) continue;
            if (now < i.due || !to.ready())
            {
                next = std::min(next, std::max<Clock::duration>(i.due - now, kShortest));
                continue;
            }
            (void)to.send(kind_, i.message);
            i.waits = false, i.due = now + kShortest, i.message.skipped = 0;
        }
        std::erase_if(instances_, [](const Instance& i) { return i.message.gone && !i.waits; });
        return next;
    }

private:
    struct Instance
    {
        PersonMessage<Sample> message;
        bool waits = false;
        Clock::time_point due{};
    };
    void keep(const T& from, bool gone)
    {
        wire::read_sample(from, read_);
        const auto found =
            std::find_if(instances_.begin(), instances_.end(), [&](const Instance& i) { return same(i.message.sample, read_); });
        if (found == instances_.end())
        {
            if (instances_.size() < kMost) instances_.push_back({{read_, gone, 0}, true, {}});
            return;
        }
        found->message.skipped += found->waits && !gone && !found->message.gone ? 1 : 0;
        found->message.sample = read_, found->message.gone = gone, found->waits = true;
    }
    static bool same(const wire::UserSample& a, const wire::UserSample& b) { return a.client == b.client && a.user == b.user; }
    static bool same(const wire::ViewerSample& a, const wire::ViewerSample& b) { return a.client == b.client && a.viewer == b.viewer; }

    Up kind_;
    wire::DataReader<T> reader_;
    Sample read_;
    std::vector<Instance> instances_;
};

}  // namespace plab::bus
