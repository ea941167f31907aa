#include "viewer/live_source.h"

namespace plab::view
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr link::Seconds kNap{0.02};
/// Frames and catalogue are separate topics without a common order: a frame of a new revision waits this long for the catalogue
/// of that revision.
constexpr std::chrono::milliseconds kSettle{150};
constexpr std::size_t kMostHeld = 64;  ///< number of frames that may wait; further ones are passed on at once

constexpr link::Parts kParts =
    link::Part::Server | link::Part::Scene | link::Part::Objects | link::Part::Shapes | link::Part::Interactions | link::Part::Metrics;

}  // namespace

Result<std::unique_ptr<Source>> LiveSource::open(const link::Session& session, const Grid& grid, link::Seconds timeout,
                                                 const link::Stop& stop)
{
    std::unique_ptr<LiveSource> out(new LiveSource(session, grid));
    auto catalogue = link::Catalogue::open(session, kParts);
    if (!catalogue) return catalogue.errors();
    out->catalogue_ = catalogue.take();
    if (auto fetched = out->catalogue_->fetch(timeout, stop); !fetched) return fetched.errors();
    out->take_catalogue();
    // Subscribe only now: a reader of states that is not emptied keeps only the last four.
    auto frames = link::FrameReader::open(session);
    if (!frames) return frames.errors();
    out->frames_ = frames.take();
    out->thread_ = std::jthread([source = out.get()](const std::stop_token& token) { source->read(token); });
    return std::unique_ptr<Source>(std::move(out));
}

LiveSource::~LiveSource()
{
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
}

std::shared_ptr<const link::CatalogueContents> LiveSource::scene() const
{
    const std::lock_guard lock(mutex_);
    return scene_;
}

std::optional<link::ServerInfo> LiveSource::server() const
{
    const std::lock_guard lock(mutex_);
    return server_;
}

void LiveSource::read(const std::stop_token& stop)
{
    while (!stop.stop_requested())
    {
        (void)session_.wait(frames_, held_.empty() ? kNap : kNap / 4);
        take_frames();
        take_catalogue();
        hand_over();
        if (!catalogue_->server_is_gone()) continue;
        for (auto& [state, since] : held_) moments_.push({std::move(state), scene()});
        moments_.close("the server has gone");
        return;
    }
}

void LiveSource::take_frames()
{
    const auto now = Clock::now();
    (void)frames_.take(
        [&](const plab_v2_Frame& frame)
        {
            const bool is_new = any_frame_ && (frame.run != run_ || frame.revision != revision_);
            run_ = frame.run, revision_ = frame.revision, any_frame_ = true;
            const auto until = is_new ? now + kSettle : held_.empty() ? now : held_.back().second;
            held_.emplace_back(state_of(frame), until);
        });
}

void LiveSource::take_catalogue()
{
    (void)catalogue_->update();
    const link::CatalogueContents& now = catalogue_->now();
    const std::lock_guard lock(mutex_);
    server_ = now.server;
    // Costs come with the metrics, which do not count as changes of the scene: the first ones decide which captions are shown.
    const bool first_costs = scene_ && !scene_->metrics && now.metrics;
    if (scene_ && version_ == catalogue_->version() && !first_costs) return;
    version_ = catalogue_->version();
    scene_ = std::make_shared<const link::CatalogueContents>(now);
}

void LiveSource::hand_over()
{
    const auto now = Clock::now();
    while (!held_.empty() && (held_.front().second <= now || held_.size() > kMostHeld))
    {
        moments_.push({std::move(held_.front().first), scene()});
        held_.pop_front();
    }
}

}  // namespace plab::view
