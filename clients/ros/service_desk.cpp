#include "ros/service_desk.h"

namespace plab::ros
{
namespace
{

// simulation_interfaces/msg/SimulatorFeatures.
constexpr std::uint16_t kFeatures[] = {
    0,   // SPAWNING
    1,   // DELETING
    4,   // ENTITY_TAGS
    5,   // ENTITY_BOUNDS
    6,   // ENTITY_BOUNDS_BOX
    8,   // ENTITY_CATEGORIES
    9,   // SPAWNING_RESOURCE_STRING
    10,  // ENTITY_STATE_GETTING
    11,  // ENTITY_STATE_SETTING
    12,  // ENTITY_INFO_GETTING
    20,  // SIMULATION_RESET
    23,  // SIMULATION_RESET_SPAWNED
    24,  // SIMULATION_STATE_GETTING
    25,  // SIMULATION_STATE_SETTING
    26,  // SIMULATION_STATE_PAUSE
    31,  // STEP_SIMULATION_SINGLE
    32,  // STEP_SIMULATION_MULTIPLE
    40,  // WORLD_LOADING
    41,  // WORLD_RESOURCE_STRING
    44,  // WORLD_INFO_GETTING
    50,  // SPAWNING_ENTITIES
};

constexpr std::uint8_t kBoxBounds = 1;
/// Of what one entity adds to a response, about: bytes.
constexpr std::size_t kNameBytes = 40, kStateBytes = 240;

/// A random id as rmw_cyclonedds_cpp writes them: hexadecimal bytes with points between them.
std::string service_id(const Node& node, int number)
{
    dds_guid_t guid{};
    (void)dds_get_guid(node.participant().get(), &guid);
    std::string out;
    for (const std::uint8_t byte : guid.v)
        for (const int digit : {byte >> 4, byte & 15}) out += "0123456789abcdef"[digit];
    return out + "." + std::to_string(number);
}

}  // namespace

Result<std::unique_ptr<ServiceDesk>> ServiceDesk::open(Node& node, const Converter& converter)
{
    auto desk = std::make_unique<ServiceDesk>();
    desk->converter_ = converter;
    Result<void> all;
    int number = 0;
    const auto make = [&]<class S>(End<S>& end)
    {
        auto made = ServiceServer<S>::make(node, service_id(node, number++));
        if (made)
            end = made.take();
        else
            all = made.errors();
    };
    std::apply([&](auto&... end) { (make(end), ...); }, desk->ends_);
    if (!all) return all.errors();
    return desk;
}

void ServiceDesk::attach_to(const wire::Entity& waitset) const
{
    const auto attach = [&](const wire::Entity& reader)
    {
        (void)dds_set_status_mask(reader.get(), DDS_DATA_AVAILABLE_STATUS);
        (void)dds_waitset_attach(waitset.get(), reader.get(), 0);
    };
    std::apply([&](const auto&... end) { (attach(end->requests()), ...); }, ends_);
}

void ServiceDesk::begin(const DeskView& view, link::Requests& requests) { view_ = view, requests_ = &requests; }

void ServiceDesk::end()
{
    requests_ = nullptr, view_ = {};
    waiting_.clear(), spawned_.clear();
}

void ServiceDesk::pass(Clock::time_point now)
{
    constexpr int kMost = 10;  // of one service; ROS clients keep no more
    if (requests_ == nullptr) return;
    const auto serve = [&]<class S>(ServiceServer<S>& server)
    {
        bool more = true;
        for (int i = 0; more && i < kMost && replies_.is_due(now); ++i)
            more = server.take(
                [&](const typename S::Request& request, const ServiceCaller& caller) {
                    handle(request, Answer<S>{&server, caller});
                });
    };
    std::apply([&](auto&... end) { (serve(*end), ...); }, ends_);
    const bool has_frame = view_.newest_frame() != nullptr;
    while (!waiting_.empty() && (has_frame || now >= waiting_.front().until))
    {
        const Waiting done = std::move(waiting_.front());
        waiting_.pop_front();
        done.answer(has_frame);
    }
}

void ServiceDesk::with_frame(std::function<void(bool has_frame)> answer)
{
    constexpr std::size_t kMost = 64;
    constexpr std::chrono::seconds kPatience(2);
    if (view_.newest_frame() != nullptr || waiting_.size() >= kMost) return answer(view_.newest_frame() != nullptr);
    waiting_.push_back({std::move(answer), Clock::now() + kPatience});
}

const SceneFrame* ServiceDesk::find_entity(const std::string& name) const
{
    if (const auto group = spawned_.find(name); group != spawned_.end()) return view_.frames->find_id(group->second);
    return view_.frames->find_id(view_.names->id_of(name));
}

std::vector<const SceneFrame*> ServiceDesk::select(const EntityFilter& filter) const
{
    std::vector<const SceneFrame*> out;
    const link::CatalogueContents& scene = view_.catalogue->now();
    const Motions motions(view_.newest_frame());
    for (const SceneFrame& frame : view_.frames->all())
        if (const auto object = scene.objects.find(frame.id); object != scene.objects.end())
            if (filter.fits(frame.name, object->second, scene, motions.of(frame).pose)) out.push_back(&frame);
    return out;
}

namespace
{

Outcome not_found(const std::string& name) { return {Code::NotFound, "there is no entity '" + name + "'"}; }
Outcome no_frame() { return {Code::Failed, "the server sent no states"}; }

}  // namespace

void ServiceDesk::handle(const msg::GetSimulatorFeatures::Request&, Answer<msg::GetSimulatorFeatures> answer)
{
    msg::GetSimulatorFeatures::Response response{};
    std::vector<std::uint16_t> features(std::begin(kFeatures), std::end(kFeatures));
    std::vector<char*> formats{wire::text("plab")};
    if (converter_) formats.insert(formats.end(), {wire::text("urdf"), wire::text("mjcf")});
    show(response.features.features, features), show(response.features.spawn_formats, formats);
    response.features.custom_info = wire::text("pLab; format plab: a <component> or <plab> as in server/docs/blueprint.md");
    answer(response);
}

void ServiceDesk::handle(const msg::GetEntities::Request& request, Answer<msg::GetEntities> answer)
{
    // The request is gone when a frame arrives, its filter is not.
    const auto filter = std::make_shared<EntityFilter>();
    if (const Outcome read = filter->read(request.filters); !read.ok()) return answer(read);
    const auto reply = [this, answer, filter](bool has_frame)
    {
        if (!has_frame) return answer(no_frame());
        const std::vector<const SceneFrame*> found = select(*filter);
        msg::GetEntities::Response response{};
        std::vector<char*> names;
        for (const SceneFrame* frame : found) names.push_back(wire::text(frame->name));
        show(response.entities, names);
        answer.give({}, response);
        replies_.spend(Clock::now(), kNameBytes * found.size());
    };
    filter->needs_places() ? with_frame(reply) : reply(true);
}

void ServiceDesk::handle(const msg::GetEntitiesStates::Request& request, Answer<msg::GetEntitiesStates> answer)
{
    const auto filter = std::make_shared<EntityFilter>();
    if (const Outcome read = filter->read(request.filters); !read.ok()) return answer(read);
    with_frame(
        [this, answer, filter](bool has_frame)
        {
            if (!has_frame) return answer(no_frame());
            const std::vector<const SceneFrame*> found = select(*filter);
            msg::GetEntitiesStates::Response response{};
            const plab_v2_Frame& newest = *view_.newest_frame();
            const Motions motions(&newest);
            std::vector<char*> names;
            std::vector<msg::EntityState> states;
            for (const SceneFrame* frame : found)
                names.push_back(wire::text(frame->name)), states.push_back(state_message(motions.of(*frame), time_of(newest.time)));
            show(response.entities, names), show(response.states, states);
            answer.give({}, response);
            replies_.spend(Clock::now(), kStateBytes * found.size());
        });
}

void ServiceDesk::handle(const msg::GetEntityState::Request& request, Answer<msg::GetEntityState> answer)
{
    with_frame(
        [this, answer, name = text_of(request.entity)](bool has_frame)
        {
            const SceneFrame* const frame = find_entity(name);
            if (frame == nullptr) return answer(not_found(name));
            if (!has_frame) return answer(no_frame());
            const plab_v2_Frame& newest = *view_.newest_frame();
            msg::GetEntityState::Response response{};
            response.state = state_message(Motions(&newest).of(*frame), time_of(newest.time));
            answer.give({}, response);
        });
}

void ServiceDesk::handle(const msg::GetEntityInfo::Request& request, Answer<msg::GetEntityInfo> answer)
{
    const std::string name = text_of(request.entity);
    const SceneFrame* const frame = find_entity(name);
    if (frame == nullptr) return answer(not_found(name));
    const link::Object& object = view_.catalogue->now().objects.at(frame->id);
    msg::GetEntityInfo::Response response{};
    response.info.category.category = category_of(object);
    response.info.description = wire::text(object.name);
    const std::vector<std::string> tags = tags_of(object);
    std::vector<char*> texts;
    for (const std::string& tag : tags) texts.push_back(wire::text(tag));
    show(response.info.tags, texts);
    answer.give({}, response);
}

void ServiceDesk::handle(const msg::GetEntityBounds::Request& request, Answer<msg::GetEntityBounds> answer)
{
    const std::string name = text_of(request.entity);
    const SceneFrame* const frame = find_entity(name);
    if (frame == nullptr) return answer(not_found(name));
    const link::CatalogueContents& scene = view_.catalogue->now();
    const auto box = box_of(scene.objects.at(frame->id), scene);
    if (!box) return answer(Outcome{Code::Failed, "'" + name + "' has no shape, or one without end"});
    msg::GetEntityBounds::Response response{};
    // "Upper right and lower left corners of the box."
    std::vector<msg::RosVector> corners{vector_of(box->high), vector_of(box->low)};
    response.bounds.type = kBoxBounds;
    show(response.bounds.points, corners);
    answer.give({}, response);
}

void ServiceDesk::describe_world(simulation_interfaces_msg_dds__WorldResource_& out, wire::SequenceMemory& memory) const
{
    const auto& scene = view_.catalogue->now().scene;
    const std::string file = server() ? server()->scene_file : "";
    const std::string title = scene ? scene->title : "";
    out.name = copy_text(title.empty() ? file : title, memory);
    out.world_resource.uri = copy_text(file, memory);
    out.description = copy_text(title, memory);
}

void ServiceDesk::handle(const msg::GetCurrentWorld::Request&, Answer<msg::GetCurrentWorld> answer)
{
    msg::GetCurrentWorld::Response response{};
    wire::SequenceMemory memory;
    describe_world(response.world, memory);
    answer.give({}, response);
}

}  // namespace plab::ros
