#include "ros/connection.h"

namespace plab::ros
{
namespace
{

constexpr std::chrono::milliseconds kNap(20), kIdleNap(50);
/// Of a paused server's clock: nodes that start meanwhile wait for it.
constexpr std::chrono::milliseconds kClockAgain(100);
constexpr std::chrono::seconds kNewcomers(1), kFramesForServices(5);
/// Of one transform and one joint without their names, about.
constexpr std::size_t kTransformBytes = 100, kJointBytes = 32;

constexpr auto kParts = link::Part::Objects | link::Part::Shapes | link::Part::Interactions;

}  // namespace

Result<Publishers> Publishers::make(Node& node)
{
    Publishers out;
    Result<void> all;
    const auto make = [&]<class Message>(Publisher<Message>& publisher, const msg::MessageTopic& topic)
    {
        auto made = Publisher<Message>::make(node, topic);
        if (made)
            publisher = made.take();
        else
            all = made.errors();
    };
    make(out.clock, msg::kClock), make(out.transforms, msg::kTransforms), make(out.static_transforms, msg::kStaticTransforms);
    make(out.joint_states, msg::kJointStates), make(out.markers, msg::kMarkers), make(out.contacts, msg::kContacts);
    if (!all) return all.errors();
    return out;
}

Connection::Connection(const link::Session& session, Publishers& publishers, ServiceDesk& desk, double rate, link::Caller caller)
    : session_(session),
      publishers_(publishers),
      desk_(desk),
      requests_(std::move(caller)),
      requests_set_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE)),
      everything_set_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE)),
      clock_{Budget(rate)},
      transforms_{Budget(rate)},
      joint_states_{Budget(rate)}
{
}

Result<std::unique_ptr<Connection>> Connection::open(const link::Session& session, Publishers& publishers, ServiceDesk& desk, double rate,
                                                     const link::Stop& stop)
{
    constexpr link::Seconds kLongest(5);
    auto caller = link::Caller::make(session, kLongest, stop);
    if (!caller) return caller.errors();
    std::unique_ptr<Connection> out(new Connection(session, publishers, desk, rate, caller.take()));
    auto catalogue = link::Catalogue::open(session, kParts);
    if (!catalogue) return catalogue.errors();
    out->catalogue_ = catalogue.take();
    if (auto fetched = out->catalogue_->fetch(kLongest, stop); !fetched) return fetched.errors();
    out->started_ns_ = out->catalogue_->now().server->started_ns;
    out->follow_catalogue();
    desk.attach_to(out->requests_set_), desk.attach_to(out->everything_set_);
    Connection* const self = out.get();
    desk.begin(
        {&*out->catalogue_, &out->scene_, &out->names_, [self] { return self->newest_frame(); }, [self] { self->follow_catalogue(); }},
        out->requests_);
    return out;
}

Connection::~Connection() { desk_.end(); }

void Connection::step()
{
    const Clock::time_point now = Clock::now();
    sleep(now);
    follow_catalogue();
    if (is_over_) return;
    subscribe(Clock::now());
    take_metrics();
    publish_frame(Clock::now());
    publish_scene(Clock::now());
    take_collisions();
    desk_.pass(Clock::now());
    requests_.update();
}

void Connection::follow_catalogue()
{
    (void)catalogue_->update();
    const link::CatalogueContents& now = catalogue_->now();
    is_over_ = catalogue_->server_is_gone() || (now.server && now.server->started_ns != started_ns_);
    if (is_over_ || catalogue_->version() == version_) return;
    version_ = catalogue_->version();
    std::set<std::string> ids;
    for (const auto& [id, object] : now.objects) ids.insert(id);
    for (const auto& [id, interaction] : now.interactions) ids.insert(id);
    names_.keep_only(ids);
    scene_.rebuild(now, names_);
    joints_.rebuild(now, scene_, names_);
    is_scene_new_ = true;
}

void Connection::open_frames()
{
    frames_.reset();
    auto frames = link::FrameReader::open(session_);
    if (!frames) return;
    frames_ = frames.take();
    (void)dds_set_status_mask(frames_->entity().get(), DDS_DATA_AVAILABLE_STATUS);
    (void)dds_waitset_attach(everything_set_.get(), frames_->entity().get(), 0);
    clock_.shown = transforms_.shown = joint_states_.shown = 0;
}

bool Connection::shows_frames() const
{
    return publishers_.clock.readers() + publishers_.transforms.readers() + publishers_.joint_states.readers() > 0;
}

/// Nobody reads it: then the server need not write it.
void Connection::subscribe(Clock::time_point now)
{
    if (desk_.wants_frame()) frames_until_ = now + kFramesForServices;
    const bool wants_frames = shows_frames() || now < frames_until_;
    // A new reader gets a frame at once, also of a paused server; so does a newcomer here.
    bool has_newcomers = publishers_.clock.has_newcomers();
    has_newcomers = publishers_.transforms.has_newcomers() || has_newcomers;
    has_newcomers = publishers_.joint_states.has_newcomers() || has_newcomers;
    if (wants_frames && (!frames_ || has_newcomers)) open_frames();
    if (!wants_frames) frames_.reset();
    const bool wants_collisions = publishers_.contacts.readers() > 0;
    if (wants_collisions && !collisions_)
        if (auto reader = session_.reader<plab_v2_Collisions>()) collisions_ = reader.take();
    if (!wants_collisions) collisions_.reset();
    const bool wants_metrics = joints_.has_drives() && publishers_.joint_states.readers() > 0;
    if (wants_metrics && !metrics_reader_)
        if (auto reader = session_.reader<plab_v2_Metrics>()) metrics_reader_ = reader.take();
    if (!wants_metrics) metrics_reader_.reset(), metrics_.reset();
}

void Connection::take_metrics()
{
    if (!metrics_reader_) return;
    (void)metrics_reader_->take(
        [&](const plab_v2_Metrics& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) metrics_ = wire::value_of<link::Metrics>(sample);
        });
}

/// When the first of the topics that somebody reads may be written again.
Connection::Clock::time_point Connection::next_frame() const
{
    Clock::time_point next = clock_.budget.next();
    if (publishers_.transforms.readers() > 0) next = std::min(next, transforms_.budget.next());
    if (publishers_.joint_states.readers() > 0) next = std::min(next, joint_states_.budget.next());
    return next;
}

/// Null: none has arrived, or none is read. DDS keeps the newest ones, however long nobody looks.
const plab_v2_Frame* Connection::newest_frame()
{
    if (!frames_) return nullptr;
    (void)frames_->take([](const plab_v2_Frame&) {});
    return frames_->newest();
}

void Connection::publish_frame(Clock::time_point now)
{
    if (!frames_ || now < next_frame()) return;
    const plab_v2_Frame* const frame = newest_frame();
    if (frame == nullptr) return;
    const auto is_new = [&](const Paced& topic) { return topic.budget.is_due(now) && topic.shown != frame->sequence_number; };
    if (publishers_.clock.readers() > 0 && (is_new(clock_) || now - clock_.budget.next() > kClockAgain))
    {
        publishers_.clock.write({time_of(frame->time)});
        clock_.shown = frame->sequence_number, clock_.budget.spend(now, 0);
    }
    if (publishers_.transforms.readers() > 0 && is_new(transforms_))
    {
        const msg::Transforms& message = moving_.moving(scene_, *frame);
        if (message.transforms._length > 0) publishers_.transforms.write(message);
        transforms_.shown = frame->sequence_number;
        transforms_.budget.spend(now, kTransformBytes * message.transforms._length);
    }
    if (publishers_.joint_states.readers() > 0 && is_new(joint_states_))
    {
        const msg::JointState& message = joints_.of(*frame, metrics_ ? &*metrics_ : nullptr);
        if (message.name._length > 0) publishers_.joint_states.write(message);
        joint_states_.shown = frame->sequence_number;
        joint_states_.budget.spend(now, kJointBytes * message.name._length);
    }
}

/// What does not depend on frames: sent when it changes, and again for each newcomer, at once and a second later, because volatile readers
/// (RViz's) get nothing of before, and may not be ready when they are seen.
void Connection::publish_scene(Clock::time_point now)
{
    const bool has_new_markers = publishers_.markers.has_newcomers(), has_new_static = publishers_.static_transforms.has_newcomers();
    const bool is_again = scene_again_ != Clock::time_point{} && now >= scene_again_;
    const bool has_newcomers = has_new_markers || has_new_static;
    if (!is_again && !has_newcomers && !(is_scene_new_ && scene_budget_.is_due(now))) return;
    if (has_newcomers) scene_again_ = now + kNewcomers;
    if (is_again) scene_again_ = {};
    const link::CatalogueContents& scene = catalogue_->now();
    const msg::MarkerArray& markers = markers_.of(scene, scene_);
    if (has_newcomers || is_again || markers_.fingerprint() != marker_print_) publishers_.markers.write(markers);
    marker_print_ = markers_.fingerprint();
    publishers_.static_transforms.write(fixed_.fixed(scene_, scene.server ? scene.server->time : 0));
    is_scene_new_ = false;
    scene_budget_.spend(now, 0);
}

void Connection::take_collisions()
{
    if (!collisions_) return;
    const auto& scene = catalogue_->now().scene;
    (void)collisions_->take(
        [&](const plab_v2_Collisions& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) publishers_.contacts.write(contacts_.of(sample, scene ? scene->dt : 0, scene_));
        });
}

void Connection::sleep(Clock::time_point now)
{
    Clock::duration longest = frames_ || collisions_ ? kNap : kIdleNap;
    // Samples that may not be handled yet would end a wait at once.
    const bool reads_frames = frames_ && now >= next_frame();
    if (frames_ && !reads_frames) longest = std::min(longest, next_frame() - now);
    const bool reads_requests = now >= desk_.next();
    if (!reads_requests) longest = std::min(longest, desk_.next() - now);
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(longest).count();
    if (!reads_requests)
        dds_sleepfor(ns);
    else
        (void)dds_waitset_wait((reads_frames ? everything_set_ : requests_set_).get(), nullptr, 0, ns);
}

}  // namespace plab::ros
