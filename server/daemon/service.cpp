#include "daemon/service.h"

#include <spdlog/spdlog.h>

#include "simulation/clock.h"
#include "simulation/requests/request_words.h"
#include "simulation/snapshot/history.h"

namespace plab::daemon
{
namespace
{

void wake_up(void* wake) { static_cast<const Wake*>(wake)->wake(); }

/// Text of others, for a log: no control characters, no more than a line.
std::string one_line(std::string text)
{
    constexpr std::size_t kLongest = 300;
    if (text.size() > kLongest) text.resize(kLongest), text += " ...";
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text;
}

void log_swap(const simulation::Reply& r, const simulation::SwapReport& swap)
{
    std::string fields;
    for (const simulation::FieldFate& f : swap.fields) fields += fmt::format(" {} {}", f.field, simulation::name_of(f.fate));
    spdlog::info("step {}: {} {} -> {}; pause {:.1f} us;{}", r.step, swap.id, swap.from, swap.to, r.pause_ns * 1e-3, fields);
    spdlog::info("  first step: energy {:.9g} J -> {:.9g} J (old: {:.9g} J), error {:.3g} (old: {:.3g}), cost {:.1f} us (old: {:.1f} us)",
                 swap.energy_before, swap.with_new.energy, swap.with_old.energy, swap.with_new.error, swap.with_old.error,
                 swap.with_new.cost_ns * 1e-3, swap.with_old.cost_ns * 1e-3);
}

publish::CollectorOptions collector_options(const Options& options)
{
    publish::CollectorOptions out;
    out.states_per_second = options.states_per_second;
    return out;
}

}  // namespace

Service::Service(simulation::Simulation& simulation, plugins::PluginLibrary& library, const Options& options)
    : simulation_(&simulation),
      library_(&library),
      scene_file_(options.scene),
      threads_(static_cast<std::uint32_t>(options.threads)),
      collector_(collector_options(options),
                 options.bus || !options.record.file.empty() ? library.summaries() : std::vector<model::TypeSummary>{}),
      snapshots_(library)
{
}

Result<void> Service::open_bus(const Options& options, const Wake& wake)
{
    auto module = plugins::open_module("bus", bus::kEntryName, plugins::PluginLibrary::default_directories());
    if (!module) return module.errors();
    bus::BusOptions bus;
    bus.name = options.name, bus.version = PLAB_VERSION, bus.domain = options.domain;
    bus.network_interface = options.network_interface;
    bus.log = [](void*, const char* line) { spdlog::warn("bus: {}", line); };
    bus.wake = &wake_up, bus.wake_argument = const_cast<Wake*>(&wake);
    Error error;
    auto opened = reinterpret_cast<bus::Open>(module->entry)(bus, error);
    if (!opened) return error;
    module_ = module.take(), bus_ = std::move(opened);
    collector_.attach(*bus_);
    simulation_->draw_for(this);
    return {};
}

Result<void> Service::open_recording(const Options& options)
{
    auto module = RecordModule::load_for_writing();
    if (!module) return module.errors();
    record::RecordOptions record = record_options(options, *simulation_, *library_);
    record.log = [](void*, const char* line) { spdlog::warn("{}", line); };
    auto opened = module->record(record);
    if (!opened) return opened.errors();
    record_module_ = module.take(), recording_ = opened.take();
    collector_.attach(*recording_);
    simulation_->draw_for(this);
    return {};
}

bool Service::wanted() const
{
    return (bus_ && bus_->wants(publish::Stream::Images)) || (recording_ && recording_->wants(publish::Stream::Images));
}

bool Service::close_recording()
{
    if (!recording_) return true;
    send_snapshot(true);
    const auto closed = recording_->close();
    const publish::RecordingStatus status = recording_->progress();
    if (!closed) spdlog::error("{}", closed.error().reason);
    if (status.dropped > 0) spdlog::warn("{}: {} messages were dropped on the way to the file", status.file, status.dropped);
    spdlog::info("recorded {} messages in {} bytes: {}", status.messages, status.bytes, status.file);
    return static_cast<bool>(closed);
}

void Service::post(simulation::Request request)
{
    Origin origin;
    for (const simulation::Operation& op : request.operations)
        origin.operations.push_back(control::description_of(op)), origin.texts.push_back(control::text_of(op));
    request.id = ++last_request_;
    waiting_.emplace(request.id, std::move(origin));
    simulation_->post(std::move(request));
}

void Service::take_requests()
{
    if (!bus_) return;
    publish::RequestText text;
    while (bus_->take(text))
    {
        const std::uint64_t begin = simulation::now_ns();
        auto wanted = control::wanted_of(text, *library_);
        const auto read_ns = static_cast<double>(simulation::now_ns() - begin);
        if (!wanted)
            refuse(text, wanted.errors(), read_ns);
        else if (wanted->shutdown)
            shut_down(text);
        else
            accept(text, wanted.take(), read_ns);
    }
}

void Service::accept(const publish::RequestText& text, control::Wanted wanted, double read_ns)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    origin.read_ns = read_ns;
    for (const simulation::Operation& op : wanted.request.operations) origin.operations.push_back(control::description_of(op));
    origin.texts = text.operations;
    wanted.request.id = ++last_request_;
    waiting_.emplace(last_request_, std::move(origin));
    simulation_->post(std::move(wanted.request));
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
        answer_client(origin, std::move(reply));
    }
    waiting_.clear();
    return own;
}

void Service::shut_down(const publish::RequestText& text)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    origin.operations = {{"shutdown", "", ""}};
    simulation::Reply reply;
    reply.done = true, reply.step = simulation_->tick(), reply.revision = simulation_->revision();
    note(origin, reply);
    ++done_;
    answer_client(origin, std::move(reply));
    shutdown_ = true;
}

void Service::refuse(const publish::RequestText& text, Errors errors, double read_ns)
{
    Origin origin;
    origin.from_bus = true, origin.client = text.client, origin.number = text.number, origin.arrived_ns = text.arrived_ns;
    for (const publish::OperationText& op : text.operations) origin.operations.push_back({op.verb, op.target, op.argument});
    simulation::Reply reply;
    reply.pause_ns = read_ns;
    reply.errors = std::move(errors), reply.step = simulation_->tick(), reply.revision = simulation_->revision();
    ++refused_;
    note(origin, reply);
    answer_client(origin, std::move(reply));
}

void Service::answer_client(const Origin& origin, simulation::Reply reply)
{
    publish::Answer answer;
    answer.client = origin.client, answer.number = origin.number, answer.run = simulation_->run(), answer.time = simulation_->time();
    answer.waited_ns = static_cast<double>(simulation::now_ns()) - static_cast<double>(origin.arrived_ns) - reply.pause_ns;
    answer.reply = std::move(reply);
    bus_->answer(std::move(answer));
}

bool Service::answer()
{
    bool fine = true;
    for (simulation::Reply& reply : simulation_->take_replies())
    {
        const auto found = waiting_.find(reply.request);
        if (found == waiting_.end()) continue;  // nobody asked for it under this number
        const Origin origin = std::move(found->second);
        waiting_.erase(found);
        reply.pause_ns += origin.read_ns;
        ++(reply.done ? done_ : refused_);
        if (reply.done) write_journal(origin, reply);
        note(origin, reply);
        for (const simulation::SwapReport& swap : reply.swaps) log_swap(reply, swap);
        if (origin.from_bus)
            answer_client(origin, std::move(reply));
        else
            fine = fine && reply.done;
    }
    return fine;
}

void Service::note(const Origin& origin, const simulation::Reply& reply)
{
    for (const Error& e : reply.errors)
    {
        // What a client gets wrong is told to the client; the log of the server does not fill up with it.
        spdlog::log(origin.from_bus ? spdlog::level::debug : spdlog::level::err, "request refused at step {}: {}", reply.step,
                    one_line(e.text()));
    }
    publish::EventRecord event;
    event.time = simulation_->time();
    if (!reply.done)
    {
        event.kind = "request.refused", event.severity = Severity::Warning;
        event.component = origin.operations.empty() ? "" : origin.operations.front().target;
        event.message = reply.errors.empty() ? "" : reply.errors.front().text();
        collector_.note(*simulation_, std::move(event));
        return;
    }
    std::size_t swaps = 0;
    for (const control::Description& op : origin.operations)
    {
        event.kind = "request." + op.verb, event.component = op.target, event.message = op.argument;
        if (op.verb == "swap" && swaps < reply.swaps.size())
        {
            event.message = reply.swaps[swaps].from + " -> " + reply.swaps[swaps].to;
            ++swaps;
        }
        collector_.note(*simulation_, event);
    }
}

void Service::write_journal(const Origin& origin, const simulation::Reply& reply)
{
    publish::JournalRecord entry;
    entry.run = simulation_->run(), entry.revision = reply.revision, entry.step = reply.step, entry.time = simulation_->time();
    entry.origin = origin.from_bus ? "client" : "command line";
    entry.client = origin.client, entry.request = origin.number, entry.operations = origin.texts;
    collector_.journal(std::move(entry));
    send_named_snapshots(origin);
}

/// Whoever reads snapshots gets those that are asked for, too: this is how a client brings one home.
void Service::send_named_snapshots(const Origin& origin)
{
    if (!collector_.anybody_reads_snapshots()) return;
    for (const publish::OperationText& op : origin.texts)
    {
        if (op.verb != "snapshot") continue;
        const auto& named = simulation_->history().named();
        if (const auto kept = named.find(op.target); kept != named.end()) make_snapshot(kept->second.snapshot, op.target, "request");
    }
}

void Service::make_snapshot(const simulation::Snapshot& snapshot, const std::string& name, const char* cause)
{
    send_snapshot(true);
    snapshots_.begin(snapshot, name, cause);
}

/// Hands over the snapshot that has been made, if there is one.
void Service::send_snapshot(bool wait)
{
    auto made = snapshots_.take(wait);
    if (!made) return;
    if (*made)
        collector_.snapshot(**made);
    else
        spdlog::error("no snapshot was recorded: {}", made->error().text());
}

void Service::publish(bool stepped)
{
    collector_.collect(*simulation_, simulation_->take_changes(), stepped);
    send_snapshot(false);
    const auto cause = collector_.wants_snapshot(*simulation_);
    if (!cause) return;
    make_snapshot(simulation_->capture(), "", *cause);
    // Where a run begins it is needed before anything else: nothing of the run can be made again without it.
    if (std::string_view(*cause) == "begin") send_snapshot(true);
}

void Service::idle()
{
    collector_.idle(*simulation_);
    send_snapshot(false);
    if (const auto cause = collector_.wants_snapshot(*simulation_); cause && std::string_view(*cause) == "begin")
    {
        make_snapshot(simulation_->capture(), "", *cause);
        send_snapshot(true);
    }
}

std::vector<publish::KeptSnapshot> Service::kept_snapshots() const
{
    std::vector<publish::KeptSnapshot> out;
    for (const auto& [name, kept] : simulation_->history().named())
        out.push_back({name, kept.snapshot->run, kept.snapshot->clock.tick, kept.snapshot->clock.time(), kept.bytes});
    return out;
}

void Service::publish_status(double rate_reached, double slipped, bool slipping)
{
    if (!bus_ && !recording_) return;
    publish::Status s;
    s.scene_file = scene_file_, s.run = simulation_->run(), s.revision = simulation_->revision();
    s.step = simulation_->tick(), s.time = simulation_->time(), s.dt = simulation_->dt();
    s.paused = simulation_->paused(), s.rate_asked = simulation_->rate(), s.rate_reached = rate_reached;
    s.slipped = slipped, s.slipping = slipping, s.threads = threads_;
    s.requests_done = done_, s.requests_refused = refused_;
    const simulation::History& history = simulation_->history();
    s.rewind_from = history.can_rewind() ? history.earliest() : -1;
    s.snapshots = kept_snapshots();
    if (recording_) s.recording = recording_->progress();
    collector_.status(s);
}

void Service::show(std::uint32_t component, std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba)
{
    publish::Image image;
    image.camera = simulation_->world().id_of(component), image.run = simulation_->run();
    image.step = simulation_->tick() + 1, image.time = simulation_->time() + simulation_->dt();
    image.width = width, image.height = height, image.rgba = std::move(rgba);
    if (recording_ && recording_->wants(publish::Stream::Images)) recording_->image(publish::Image(image));
    if (bus_ && bus_->wants(publish::Stream::Images)) bus_->image(std::move(image));
}

}  // namespace plab::daemon
