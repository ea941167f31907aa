/// Reads one server on a separate thread, so that drawing never causes missed states.
#pragma once

#include <thread>

#include "link/frame_reader.h"
#include "viewer/source.h"

namespace plab::view
{

class LiveSource final : public Source
{
public:
    /// Subscribes, waits until the catalogue has arrived, and starts to read. The session must outlive it.
    static Result<std::unique_ptr<Source>> open(const link::Session& session, const Grid& grid, link::Seconds timeout,
                                                const link::Stop& stop);
    ~LiveSource() override;

    std::optional<Moment> pop(link::Seconds timeout) override { return moments_.pop(timeout); }
    std::optional<std::string> closed() const override { return moments_.closed(); }
    std::uint64_t given_up() const override { return moments_.given_up(); }
    std::shared_ptr<const link::CatalogueContents> scene() const override;
    /// They come at least once a second.
    std::optional<link::ServerInfo> server() const override;

private:
    LiveSource(const link::Session& session, const Grid& grid) : session_(session), moments_(grid) {}

    void read(const std::stop_token& stop);
    void take_frames();
    void take_catalogue();
    void hand_over();

    const link::Session& session_;
    link::FrameReader frames_;
    std::optional<link::Catalogue> catalogue_;
    MomentBuffer moments_;

    // Of the reading thread.
    std::deque<std::pair<State, std::chrono::steady_clock::time_point>> held_;  ///< until their scene is known
    std::uint64_t run_ = 0, revision_ = 0, version_ = 0;
    bool any_frame_ = false;

    mutable std::mutex mutex_;  ///< of the following two
    std::shared_ptr<const link::CatalogueContents> scene_;
    std::optional<link::ServerInfo> server_;

    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::view
