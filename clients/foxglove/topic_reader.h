/// One topic of the bus, its samples unchanged, and those of before for clients that come later.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "foxglove/outbox.h"
#include "idl/recording/sample_header.h"
#include "link/discovery.h"

namespace plab::foxglove
{

class TopicReader
{
public:
    struct Sample
    {
        std::uint64_t instance = 0;
        MessagePtr content;          ///< null: the instance is gone
        std::optional<double> time;  ///< s, simulated, if the sample has one
        std::string gone;            ///< key of an instance that is gone, if it is a text
    };

    static Result<TopicReader> open(const link::Session& session, const wire::Topic& topic);

    /// Passes on what has arrived, without waiting.
    void take(const std::function<void(const Sample&)>& handle);
    /// Of topics that keep samples for late joiners, the last one of each instance.
    const std::map<std::uint64_t, Stamped>& kept() const { return kept_; }
    /// Remembers it for those who come later.
    void keep(const Sample& sample, std::uint64_t time);

private:
    TopicReader(link::RawReader reader, const wire::Topic& topic);

    link::RawReader reader_;
    std::unique_ptr<recording::Peek> peek_;
    bool keeps_ = false;
    std::map<std::uint64_t, Stamped> kept_;
};

}  // namespace plab::foxglove
