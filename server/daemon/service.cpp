#include "daemon/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "control/replies.h"
#include "daemon/ending.h"
#include "publish/busy.h"
#include "simulation/costs/clock.h"
#include "simulation/requests/request_words.h"
#include "simulation/snapshot/history.h"

namespace plab::daemon
{
namespace
{

constexpr std::size_t kMostTimed = 4096;

/// Makes foreign text safe for a log: no control characters, at most one line.
std::string one_line(std::string text)
{
    constexpr std::size_t kLongestLine = 300;
    if (text.size() > kLongestLine) text.resize(kLongestLine), text += " ...";
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text;
}

void log_swap(const simulation::Reply& r, const simulation::SwapReport& swap)
{
    std::string fields;
    for (const simulation::TransferredField& f : swap.fields) fields += fmt::format(" {} {}", f.field, simulation::name_of(f.transfer));
    spdlog::info("step {}: {} {} -> {}; pause {:.1f} us;{}", r.step, swap.id, swap.from, swap.to, r.pause_ns * 1e-3, fields);
    if (std::isnan(swap.with_new.energy)) return;  // not tried
    const std::string costs = simulation::text_of_costs(r.trial);
    spdlog::info("  first step: energy {:.9g} J -> {:.9g} J (old: {:.9g} J), error {:.3g} (old: {:.3g}){}", swap.energy_before,
                 swap.with_new.energy, swap.with_old.energy, swap.with_new.error, swap.with_old.error, costs.empty() ? "" : "; " + costs);
}

publish::CollectorOptions collector_options(const DaemonOptions& options)
{
    publish::CollectorOptions out;
    out.states_per_second = options.states_per_second;
    out.error_share = options.error_share;
    return out;
}

}  // namespace

Service::Service(simulation::Simulation& simulation, plugins::PluginLibrary& library, const DaemonOptions& options)
    : simulation_(&simulation),
      library_(&library),
      scene_file_(options.scene.empty() ? simulation.world().scene().file : options.scene),
      threads_(static_cast<std::uint32_t>(options.threads)),
      collector_(collector_options(options),
                 options.bus || !options.record.file.empty() ? library.summaries() : std::vector<model::TypeSummary>{}),
      people_(simulation),
      snapshots_(library,
                 [this]
                 {
                     if (wake_) wake_->wake();
                 })
{
}

Service::~Service()
{
    if (reader_) reader_->stop();
}

Result<void> Service::open_bus(const DaemonOptions& options, const Wake& wake, Interruption& interruption)
{
    auto module = plugins::open_module("bus", bus::kEntryName, plugins::PluginLibrary::default_directories());
    if (!module) return module.errors();
    bus::BusOptions bus;
    bus.name = options.name, bus.version = PLAB_VERSION, bus.domain = options.domain;
    bus.network_interface = options.network_interface;
    bus.ros = {options.ros, options.ros_namespace, options.ros_rate};
    bus.log = [](void*, const char* line) { spdlog::warn("bus: {}", line); };
    bus.end = [](void* to) { static_cast<Interruption*>(to)->ask(kGrace); };
    bus.end_argument = &interruption;
    bus.busy = [](void* of)
    {
        const publish::Busy busy = publish::busy_of(*static_cast<const simulation::Progress*>(of));
        return busy.what.empty() ? std::string() : publish::text_of(busy);
    };
    bus.busy_argument = const_cast<simulation::Progress*>(&simulation_->progress());
    bus.wake = [](void* service) { static_cast<Service*>(service)->wake_up(); };
    bus.wake_argument = this;
    wake_ = &wake, interruption_ = &interruption;
    // The reader exists before the bus, which may call wake_up() as soon as it is open.
    reader_ = std::make_unique<RequestReader>([this](publish::ReceivedRequest& text) { return bus_is_open_ && bus_->take(text); },
                                              *library_, simulation_->limits(), [&wake] { wake.wake(); });
    Error error;
    auto opened = reinterpret_cast<bus::Open>(module->entry)(bus, error);
    if (!opened) return error;
    module_ = module.take(), bus_ = std::move(opened), bus_is_open_ = true;
    reader_->notify();
    collector_.attach(*bus_);
    simulation_->draw_for(this);
    return {};
}

void Service::post(simulation::Request request)
{
    Origin origin;
    for (const simulation::Operation& op : request.operations) origin.texts.push_back(control::text_of(op));
    post(std::move(request), std::move(origin));
}

void Service::post(simulation::Request request, Origin origin)
{
    for (const simulation::Operation& op : request.operations) origin.operations.push_back(control::description_of(op));
    request.id = ++last_request_;
    if (request.at) timed_.emplace(request.id, origin);
    if (timed_.size() > kMostTimed) timed_.erase(timed_.begin());
    waiting_.emplace(request.id, std::move(origin));
    simulation_->post(std::move(request));
}

/// Something happened on the bus: perhaps a request, which is read before the loop can use it, perhaps something else.
void Service::wake_up() const
{
    reader_->notify();
    wake_->wake();
}

void Service::take_requests()
{
    if (!bus_) return;
    note_restart();
    // A client asked for the shutdown, which takes its turn behind what is being read: a step begun now would be given up.
    constexpr std::chrono::seconds kLongestRead(10);
    if (interruption_->asked()) reader_->finish(kLongestRead);
    RequestReader::ReadRequest next;
    while (reader_->take(next))
    {
        if (!next.wanted)
            refuse(next.text, next.wanted.errors());
        else if (next.wanted->shutdown)
            shut_down(next.text);
        else if (next.wanted->cancel)
            cancel(next.text, *next.wanted->cancel);
        else
            accept(next.text, next.wanted.take());
    }
}

void Service::show_scene()
{
    if (reader_) reader_->show(simulation_->world().lend_scene());
}

void Service::take_last_requests(std::chrono::milliseconds most)
{
    if (reader_) reader_->finish(most);
    take_requests();
}

void Service::note_restart()
{
    wire::EventInfo event;
    event.message = bus_->take_restart();
    if (event.message.empty()) return;
    event.kind = "bus.restarted", event.severity = "warning";
    collector_.note(*simulation_, std::move(event));
}

void Service::accept(const publish::ReceivedRequest& text, control::Wanted wanted)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    origin.texts = text.operations;
    post(std::move(wanted.request), std::move(origin));
}

/// The client that asked. A request that a snapshot restored still belongs to that client, which was answered long ago.
std::optional<Service::Origin> Service::origin_of(std::uint64_t request)
{
    if (auto asked = waiting_.extract(request)) return std::move(asked.mapped());
    const auto said = timed_.find(request);
    if (said == timed_.end()) return {};
    Origin origin = said->second;
    origin.was_answered = true;
    return origin;
}

std::size_t Service::close()
{
    std::size_t own = 0;
    for (const auto& [id, origin] : waiting_)
    {
        if (!origin.from_bus)
        {
            ++own;
            continue;
        }
        simulation::Reply reply;
        reply.step = simulation_->tick(), reply.revision = simulation_->revision();
        reply.errors = {reason("the server ended before the step that the request names")};
        answer_client(origin, reply);
    }
    waiting_.clear();
    return own;
}

void Service::shut_down(const publish::ReceivedRequest& text)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    origin.operations = {{"shutdown", "", ""}};
    simulation::Reply reply;
    reply.done = true, reply.step = simulation_->tick(), reply.revision = simulation_->revision();
    note(origin, reply);
    ++done_;
    answer_client(origin, reply);
    shutdown_ = true;
}

/// The client that waits for the request gets the reply that it was cancelled.
void Service::cancel(const publish::ReceivedRequest& text, const control::Wanted::Cancelled& which)
{
    const auto waits = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const auto& w) { return w.second.client == which.client && w.second.number == which.number; });
    if (waits == waiting_.end() || !simulation_->withdraw(waits->first))
        return refuse(text, Errors{reason("no such request is waiting: it took effect, was refused, or never arrived")});
    simulation::Reply taken_back;
    taken_back.step = simulation_->tick(), taken_back.revision = simulation_->revision();
    taken_back.errors = {reason("cancelled before it took effect")};
    const Origin origin = std::move(waiting_.extract(waits).mapped());
    note(origin, taken_back);
    ++refused_;
    answer_client(origin, taken_back);
    Origin asker;
    asker.from_bus = true, asker.client = text.client, asker.number = text.number, asker.arrived_ns = text.arrived_ns;
    asker.operations = {{"cancel", "", text.operations.front().argument}};
    simulation::Reply reply;
    reply.done = true, reply.step = simulation_->tick(), reply.revision = simulation_->revision();
    note(asker, reply);
    ++done_;
    answer_client(asker, reply);
}

void Service::refuse(const publish::ReceivedRequest& text, Errors errors)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    for (const wire::Operation& op : text.operations) origin.operations.push_back({op.verb, op.target, op.argument});
    simulation::Reply reply;
    reply.errors = std::move(errors), reply.step = simulation_->tick(), reply.revision = simulation_->revision();
    ++refused_;
    note(origin, reply);
    answer_client(origin, reply);
}

void Service::answer_client(const Origin& origin, const simulation::Reply& reply)
{
    wire::Reply answer = control::reply_of(reply);
    answer.client = origin.client, answer.number = origin.number, answer.run = simulation_->run(), answer.time = simulation_->time();
    answer.waited_ns = static_cast<double>(simulation::now_ns()) - static_cast<double>(origin.arrived_ns) - reply.pause_ns;
    bus_->answer(std::move(answer));
}

bool Service::answer()
{
    bool fine = true;
    for (simulation::Reply& reply : simulation_->take_replies())
    {
        const auto asked = origin_of(reply.request);
        if (!asked) continue;  // no client sent a request with this number
        const Origin& origin = *asked;
        ++(reply.done ? done_ : refused_);
        if (reply.done) write_journal(origin, reply);
        note(origin, reply);
        for (const simulation::SwapReport& swap : reply.swaps) log_swap(reply, swap);
        if (!origin.from_bus)
            fine = fine && reply.done;
        else if (!origin.was_answered)
            answer_client(origin, reply);
    }
    return fine;
}

void Service::note(const Origin& origin, const simulation::Reply& reply)
{
    for (const Error& e : reply.errors)
    {
        // Errors of a client are reported to the client; they must not fill the server's log.
        spdlog::log(origin.from_bus ? spdlog::level::debug : spdlog::level::err, "request refused at step {}: {}", reply.step,
                    one_line(e.text()));
    }
    wire::EventInfo event;
    event.time = simulation_->time();
    if (!reply.done)
    {
        event.kind = "request.refused", event.severity = "warning";
        event.component_id = origin.operations.empty() ? "" : origin.operations.front().target;
        event.message = reply.errors.empty() ? "" : reply.errors.front().text();
        collector_.note(*simulation_, std::move(event));
        return;
    }
    event.severity = "info";
    for (const control::Description& op : origin.operations)
    {
        if (op.verb == "swap") continue;
        event.kind = "request." + op.verb, event.component_id = op.target, event.message = op.argument;
        collector_.note(*simulation_, event);
    }
    // One request may exchange many components; a pattern does not name them individually.
    for (const simulation::SwapReport& swap : reply.swaps)
    {
        event.kind = "request.swap", event.component_id = swap.id, event.message = swap.from + " -> " + swap.to;
        collector_.note(*simulation_, event);
    }
}

void Service::publish(bool stepped)
{
    collector_.collect(*simulation_, simulation_->take_changes(), stepped);
    if (stepped) publish_forces();
    send_snapshots();
    if (const auto cause = collector_.wants_snapshot(*simulation_)) make_snapshot(simulation_->capture(), "", *cause);
}

void Service::idle()
{
    collector_.idle(*simulation_);
    send_snapshots();
    if (const auto cause = collector_.wants_snapshot(*simulation_); cause && std::string_view(*cause) == "begin")
        make_snapshot(simulation_->capture(), "", *cause);
}

void Service::publish_status(double rate_reached, double slipped, bool slipping)
{
    if (!bus_ && !recording_) return;
    wire::Server s;
    s.scene_file = scene_file_, s.run = simulation_->run(), s.revision = simulation_->revision();
    s.step = simulation_->tick(), s.time = simulation_->time(), s.dt = simulation_->dt();
    s.paused = simulation_->paused(), s.rate_asked = simulation_->rate(), s.rate_reached = rate_reached;
    s.slipped = slipped, s.overload = slipping ? "slip" : "", s.threads = threads_;
    s.requests_done = done_, s.requests_refused = refused_;
    const simulation::History& history = simulation_->history();
    s.rewind_from = history.can_rewind() ? history.earliest() : -1;
    s.snapshots = kept_snapshots();
    if (recording_) s.recording = recording_->progress(), s.recording.dropped += snapshots_.left_out();
    collector_.status(s);
}

void Service::show(std::uint32_t component, std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba)
{
    wire::Image image;
    image.camera = simulation_->world().id_of(component), image.run = simulation_->run();
    image.step = simulation_->tick() + 1, image.time = simulation_->time() + simulation_->dt();
    image.width = width, image.height = height, image.encoding = "rgba8", image.data = std::move(rgba);
    if (recording_ && recording_->wants(publish::Stream::Images)) recording_->image(wire::Image(image));
    if (bus_ && bus_->wants(publish::Stream::Images)) bus_->image(std::move(image));
}

}  // namespace plab::daemon
