/// The bridge while there is a server.
#pragma once

#include "link/frame_reader.h"
#include "ros/contacts.h"
#include "ros/joints.h"
#include "ros/markers.h"
#include "ros/service_desk.h"
#include "ros/transforms.h"

namespace plab::ros
{

/// Writers of all topics; they outlive a server, as a ROS node does.
struct Publishers
{
    Publisher<msg::Clock> clock;
    Publisher<msg::Transforms> transforms, static_transforms;
    Publisher<msg::JointState> joint_states;
    Publisher<msg::MarkerArray> markers;
    Publisher<msg::Contacts> contacts;

    static Result<Publishers> make(Node& node);
};

class Connection
{
public:
    /// Waits for the whole catalogue. All arguments must outlive it.
    static Result<std::unique_ptr<Connection>> open(const link::Session& session, Publishers& publishers, ServiceDesk& desk, double rate,
                                                    const link::Stop& stop);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Sleeps until there is something to do, 50 ms at most, and does it.
    void step();
    /// The server has gone, or another one has taken its name.
    bool is_over() const { return is_over_; }

private:
    using Clock = Budget::Clock;
    /// A topic that shows frames: when it may be written again, and which frame it has shown.
    struct Paced
    {
        Budget budget;
        std::uint64_t shown = 0;
    };

    Connection(const link::Session& session, Publishers& publishers, ServiceDesk& desk, double rate, link::Caller caller);
    void follow_catalogue();
    void subscribe(Clock::time_point now);
    void open_frames();
    const plab_v2_Frame* newest_frame();
    void publish_frame(Clock::time_point now);
    void publish_scene(Clock::time_point now);
    void take_collisions();
    void take_metrics();
    bool shows_frames() const;
    Clock::time_point next_frame() const;
    void sleep(Clock::time_point now);

    const link::Session& session_;
    Publishers& publishers_;
    ServiceDesk& desk_;
    link::Requests requests_;
    std::optional<link::Catalogue> catalogue_;
    std::uint64_t version_ = 0;
    std::int64_t started_ns_ = 0;
    bool is_over_ = false;

    // Read only while somebody reads what is made of them.
    std::optional<link::FrameReader> frames_;
    std::optional<wire::DataReader<plab_v2_Collisions>> collisions_;
    std::optional<wire::DataReader<plab_v2_Metrics>> metrics_reader_;
    std::optional<link::Metrics> metrics_;
    Clock::time_point frames_until_{};  ///< for services
    wire::Entity requests_set_, everything_set_;

    NameTable names_;
    SceneFrames scene_;
    TransformMessage moving_, fixed_;
    JointMessage joints_;
    MarkerMessage markers_;
    ContactMessage contacts_;
    Paced clock_, transforms_, joint_states_;
    Budget scene_budget_{1};           ///< markers and static transforms change once a second at most
    std::uint64_t marker_print_ = 0;   ///< of the markers that were sent
    Clock::time_point scene_again_{};  ///< when newcomers get them once more
    bool is_scene_new_ = true;
};

}  // namespace plab::ros
