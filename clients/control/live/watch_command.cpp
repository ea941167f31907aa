#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "control/live/commands.h"
#include "control/live/watch_print.h"
#include "idl/samples.h"
#include "link/frame_reader.h"
#include "link/names.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

const std::vector<std::string> kStreams{"states", "contacts", "collisions", "events", "metrics"};

struct WatchOptions
{
    std::string stream;
    std::vector<std::string> only;
    double every = 0;  ///< s, simulated
};

/// -n, -d and Ctrl-C.
class Limit
{
public:
    explicit Limit(const Context& context);
    /// One more sample was printed.
    void count() { ++seen_; }
    bool is_reached() const { return (most_ && seen_ >= *most_) || is_over(); }
    bool is_over() const { return end_ && std::chrono::steady_clock::now() >= *end_; }
    /// How long to wait for the next sample: short, so that Ctrl-C is noticed.
    link::Seconds slice() const;

private:
    std::optional<std::uint64_t> most_;
    std::optional<std::chrono::steady_clock::time_point> end_;
    std::uint64_t seen_ = 0;
};

/// Checks sequence numbers, which the server assigns without gaps.
class Numbers
{
public:
    /// Takes `count` samples from `first` on; returns how many are missing before them. The first call only starts; a smaller
    /// number means that the server was restarted.
    std::uint64_t missed_before(std::uint64_t first, std::uint64_t count);
    std::uint64_t missed() const { return missed_; }

private:
    std::optional<std::uint64_t> next_;
    std::uint64_t missed_ = 0;
};

Limit::Limit(const Context& context) : most_(context.settings.count)
{
    if (context.settings.duration) end_ = link::moment_after(link::Seconds(*context.settings.duration));
}

link::Seconds Limit::slice() const
{
    constexpr link::Seconds kSlice(0.1);
    if (!end_) return kSlice;
    return std::clamp(link::Seconds(*end_ - std::chrono::steady_clock::now()), link::Seconds(0), kSlice);
}

std::uint64_t Numbers::missed_before(std::uint64_t first, std::uint64_t count)
{
    const std::uint64_t missed = next_ && first > *next_ ? first - *next_ : 0;
    next_ = first + count;
    missed_ += missed;
    return missed;
}

/// Lets one sample through in each interval of simulated time; a new run begins anew.
class Thinning
{
public:
    explicit Thinning(double every) : every_(every) {}
    bool takes(std::uint64_t run, double time)
    {
        // Half a nanosecond: times are multiples of dt, and rounding must not cost a sample.
        if (run == run_ && time + 5e-10 < next_) return false;
        next_ = run == run_ && next_ + every_ > time ? next_ + every_ : time + every_;
        run_ = run;
        return true;
    }

private:
    double every_, next_ = 0;
    std::uint64_t run_ = static_cast<std::uint64_t>(-1);
};

struct Watch
{
    Context& context;
    link::Catalogue& catalogue;
    WatchPrinter printer;
    Limit limit;
    Thinning thinning;
    Numbers numbers;
};

/// Calls `take(reader)` until a limit is reached, the server is gone, or Ctrl-C.
template <class Reader, class Take>
Exit follow(Watch& w, Result<Reader> reader, Take take)
{
    if (!reader) return w.context.fail(Exit::Failed, reader.errors());
    while (!w.limit.is_reached())
    {
        if (w.context.stopped()) return Exit::Interrupted;
        (void)w.catalogue.update();
        take(*reader);
        if (!w.context.console.flush()) return Exit::Done;  // the reader is gone: `| head` has enough
        if (w.limit.is_reached()) break;
        if (w.catalogue.server_is_gone()) return w.context.fail(Exit::NoServer, "server '" + w.context.session().server() + "' has gone");
        (void)w.context.session().wait(*reader, w.limit.slice());
    }
    return Exit::Done;
}

/// Passes samples of T to `handle`.
template <class T, class Handle>
Exit stream(Watch& w, Handle handle)
{
    const auto pass_on = [&](const T& sample, const dds_sample_info_t& info)
    {
        if (info.valid_data && !w.limit.is_reached()) handle(sample);
    };
    return follow(w, w.context.session().reader<T>(), [&](wire::DataReader<T>& reader) { (void)reader.take(pass_on); });
}

Exit watch_states(Watch& w)
{
    const auto show = [&](const plab_v2_Frame& frame)
    {
        if (w.limit.is_reached()) return;
        (void)w.numbers.missed_before(frame.sequence_number, 1);
        if (!w.thinning.takes(frame.run, frame.time)) return;
        w.printer.frame(frame_of(frame), w.catalogue);
        w.limit.count();
    };
    const Exit e = follow(w, link::FrameReader::open(w.context.session()), [&](link::FrameReader& reader) { (void)reader.take(show); });
    // A slow reader misses frames: states are delivered that way, so this is not a failure.
    if (w.numbers.missed() > 0) w.context.console.say("plabctl: " + std::to_string(w.numbers.missed()) + " frames were not delivered");
    return e;
}

/// Samples of T as values, one in each interval.
template <class T, class Value, class Print>
Exit watch_samples(Watch& w, Print print)
{
    return stream<T>(w,
                     [&](const T& sample)
                     {
                         if (!w.thinning.takes(sample.run, sample.time)) return;
                         print(wire::value_of<Value>(sample));
                         w.limit.count();
                     });
}

template <class T, class Print>
Exit watch_log(Watch& w, const char* what, Print print)
{
    return stream<T>(w,
                     [&](const T& sample)
                     {
                         const std::uint32_t count = sample.entries._length;
                         if (const auto missed = w.numbers.missed_before(sample.sequence_number, count); missed > 0)
                             w.printer.gap(what, missed, sample.sequence_number);
                         for (std::uint32_t i = 0; i < count && !w.limit.is_reached(); ++i)
                             if (print(sample, i)) w.limit.count();
                     });
}

template <class T>
void add_ids(const std::map<std::string, T>& things, std::vector<std::string>& out)
{
    for (const auto& [id, thing] : things) out.push_back(id);
}

/// The objects that a stream concerns, as far as the scene has them now.
std::vector<std::string> known_to(const std::string& stream, const link::CatalogueContents& now)
{
    std::vector<std::string> out;
    if (stream != "metrics") add_ids(now.objects, out);
    if (stream != "states") add_ids(now.interactions, out);
    if (stream == "events") add_ids(now.shapes, out);
    return out;
}

link::Parts parts_for(const WatchOptions& o)
{
    if (o.only.empty()) return o.stream == "states" ? static_cast<link::Parts>(link::Part::Objects) : 0;
    return link::Part::Objects | link::Part::Interactions | link::Part::Shapes;
}

/// States and metrics of an unknown object would stay empty: that is an error. The others may concern a component
/// that is added later: then a note is printed, and the command waits.
Exit check_names(const Context& c, const WatchOptions& o, const link::CatalogueContents& now)
{
    const std::vector<std::string> known = known_to(o.stream, now);
    const bool is_error = o.stream == "states" || o.stream == "metrics";
    Exit out = Exit::Done;
    for (const std::string& id : o.only)
    {
        if (std::find(known.begin(), known.end(), id) != known.end()) continue;
        const std::string what = o.stream == "states" ? "no object '" : o.stream == "metrics" ? "no interaction '" : "no component '";
        const std::string head = what + id + "'" + link::did_you_mean(id, known);
        if (!is_error)
        {
            c.console.say("plabctl: " + printable(head) + "; it will be shown if it is added later");
            continue;
        }
        std::string list;
        for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
        out = c.fail(Exit::Failed, head + "; there are: " + (list.empty() ? "none" : list));
    }
    return out;
}

Exit run_watch(Context& c, const WatchOptions& o)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = link::Catalogue::open(c.session(), parts_for(o));
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    if (const Exit e = check_names(c, o, catalogue->now()); e != Exit::Done) return e;
    // These come when something happens, which may take long: say so where a person waits.
    if (c.console.is_terminal() && o.stream != "states" && o.stream != "metrics")
        c.console.say("plabctl: " + o.stream + " of server '" + printable(c.session().server()) + "' as they come; Ctrl-C ends");
    const Selection selection{{o.only.begin(), o.only.end()}};
    Watch w{c, *catalogue, WatchPrinter(c.console, c.settings.json, selection), Limit(c), Thinning(o.every), {}};
    if (o.stream == "states") return watch_states(w);
    if (o.stream == "metrics")
        return watch_samples<plab_v2_Metrics, wire::Metrics>(w, [&](const wire::Metrics& m) { w.printer.metrics(m); });
    if (o.stream == "contacts")
        return watch_samples<plab_v2_ContactForces, wire::ContactForces>(
            w, [&](wire::ContactForces&& all) { w.printer.contacts(std::move(all)); });
    if (o.stream == "collisions")
        return watch_log<plab_v2_Collisions>(w, "collisions",
                                             [&](const auto& sample, std::uint32_t i) { return w.printer.collision(sample, i); });
    return watch_log<plab_v2_Events>(w, "events", [&](const auto& sample, std::uint32_t i) { return w.printer.event(sample, i); });
}

std::string check_stream(const std::string& text)
{
    for (const std::string& known : kStreams)
        if (text == known) return {};
    return "no stream '" + text + "'" + link::did_you_mean(text, kStreams) + " There are states, contacts, collisions, events and metrics";
}

}  // namespace

const std::vector<std::string>& watch_streams() { return kStreams; }

void add_watch_command(const Command& app, Context& context)
{
    auto o = std::make_shared<WatchOptions>();
    const Command command = add_command(app, context,
                                        {"watch", "print states, contacts, collisions, events or metrics as they arrive",
                                         "  plabctl watch events\n"
                                         "  plabctl watch states --every 0.5 --only red -n 20\n"
                                         "  plabctl watch contacts --only red -n 1\n"
                                         "  plabctl watch collisions -d 60 --json > collisions.ndjson\n"},
                                        [o](Context& c) { return run_watch(c, *o); });
    command.add_option("stream", o->stream, "states, contacts, collisions, events or metrics")
        .required()
        .type_name("STREAM")
        .check(check_stream);
    command.add_option("--only", o->only, "only what concerns this component (may be repeated)").repeated().type_name("ID");
    command.add_option("--every", o->every, "of states, contacts and metrics: one sample per this much simulated time")
        .check(link::check_positive)
        .type_name("SECONDS");
}

}  // namespace plab::cli
