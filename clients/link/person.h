/// The samples of a person: where a hand or a device is, or from where somebody looks (plab/users, plab/viewers).
///
///   auto hand = link::UserWriter::open(session, "hand", 2s);
///   hand->send({.position = {0, 0, 1}, .grip = 1});      // as often as it moves, up to 1000 times a second
///
/// Destroying the writer lets go: the server learns at once that this person is gone.
#pragma once

#include <chrono>
#include <random>
#include <thread>

#include "idl/samples.h"
#include "link/session.h"

namespace plab::link
{

/// T: type on the wire. Sample: its value. A writer is one client, which moves one component.
template <class T, class Sample>
class PersonWriter
{
public:
    /// `component`: that it moves; empty: the first one that no other client moves. Waits until the server reads it.
    static Result<PersonWriter> open(const Session& session, const std::string& component, Seconds timeout, const Stop& stop = {})
    {
        auto writer = session.writer<T>();
        if (!writer) return writer.errors();
        PersonWriter out;
        out.writer_ = writer.take();
        component_of(out.last_) = component;
        std::random_device random;
        for (std::uint8_t& byte : out.last_.client) byte = static_cast<std::uint8_t>(random());
        const auto end = moment_after(timeout);
        while (out.writer_.readers() == 0)
        {
            if (std::chrono::steady_clock::now() >= end || (stop && stop()))
                return reason("the server reads no " + std::string(wire::topic_of<T>().name));
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return out;
    }
    PersonWriter(PersonWriter&&) noexcept = default;
    PersonWriter& operator=(PersonWriter&&) noexcept = default;
    ~PersonWriter()
    {
        if (writer_.entity().valid() && last_.number > 0) (void)writer_.dispose(view_.of(last_));
    }

    /// Client, component, number and time stamp are filled in.
    Result<void> send(Sample sample)
    {
        sample.client = last_.client, component_of(sample) = component_of(last_), sample.number = last_.number + 1;
        sample.stamp_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
        last_ = std::move(sample);
        if (const auto code = writer_.write(view_.of(last_)); code < 0)
            return wire::failed(std::string("cannot write ") + wire::topic_of<T>().name, code);
        return {};
    }
    const wire::ClientId& client() const { return last_.client; }

private:
    PersonWriter() = default;
    static std::string& component_of(wire::UserSample& s) { return s.user; }
    static std::string& component_of(wire::ViewerSample& s) { return s.viewer; }

    wire::DataWriter<T> writer_;
    wire::SampleView<T> view_;
    Sample last_;
};

using UserWriter = PersonWriter<plab_v2_UserSample, wire::UserSample>;
using ViewerWriter = PersonWriter<plab_v2_ViewerSample, wire::ViewerSample>;

}  // namespace plab::link
