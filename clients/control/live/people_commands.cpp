// grab, view: a person's hand, and a person's eye.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "control/live/commands.h"
#include "control/live/frames.h"
#include "control/live/request.h"
#include "link/catalogue.h"
#include "link/names.h"
#include "link/numbers.h"
#include "link/person.h"
#include "link/text.h"
#include "plab/xml_text.h"

namespace plab::cli
{
namespace
{

using Clock = std::chrono::steady_clock;

Result<Vec3> parse_place(const std::string& text, const char* option)
{
    std::array<double, 3> out{};
    const char *at = text.data(), *const end = at + text.size();
    for (double& number : out)
    {
        while (at < end && (*at == ' ' || *at == ',')) ++at;
        const auto read = std::from_chars(at, end, number);
        if (read.ec != std::errc() || !std::isfinite(number)) return reason(std::string(option) + ": '" + text + "' is not X Y Z");
        at = read.ptr;
    }
    if (at != end) return reason(std::string(option) + ": '" + text + "' is not X Y Z");
    return Vec3{out[0], out[1], out[2]};
}

std::string text_of_place(const Vec3& v) { return exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z); }

/// Calls send(seconds since the beginning) at a rate until it returns false, or after Ctrl-C.
template <class Send>
Result<void> at_rate(const Context& c, double rate, Send send)
{
    const Clock::time_point begin = Clock::now();
    for (std::uint64_t n = 0; !c.stopped(); ++n)
    {
        const auto due = link::moment_after(link::Seconds(static_cast<double>(n) / rate), begin);
        std::this_thread::sleep_until(due);
        auto more = send(link::Seconds(Clock::now() - begin).count());
        if (!more) return more.errors();
        if (!*more) return {};
    }
    return {};
}

// ---- grab -----------------------------------------------------------------------------------------------------------

struct GrabOptions
{
    std::string id, to, by;
    double force = 500, speed = 0.5, rate = 100;
    std::optional<double> over, lasting;
};

/// Where the body is now.
Result<Vec3> place_of(Context& c, const std::string& id)
{
    auto catalogue = link::Catalogue::open(c.session(), static_cast<link::Parts>(link::Part::Objects));
    if (!catalogue) return catalogue.errors();
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return fetched.errors();
    const auto& objects = catalogue->now().objects;
    const auto found = objects.find(id);
    if (found == objects.end()) return reason("no object has the id '" + id + "'");
    if (link::is_shaft(found->second) || found->second.motion != "dynamic")
        return reason("'" + id + "' is no body that forces move, so it cannot be grabbed");
    if (const auto frame = next_frame(c.session(), link::Seconds(0.5)))
        if (const auto motion = frame->motions.find(found->second.handle); motion != frame->motions.end()) return motion->second.position;
    return found->second.position;
}

/// Moves the hand, and returns the largest force on it.
Result<double> move_hand(Context& c, const GrabOptions& o, const std::string& hand, const Vec3& from, const Vec3& to)
{
    auto writer = link::UserWriter::open(c.session(), hand, c.timeout(), c.stop());
    if (!writer) return writer.errors();
    auto forces = c.session().reader<plab_v2_Forces>();
    if (!forces) return forces.errors();
    const double way = length(to - from), over = std::max(1e-3, o.over.value_or(way / o.speed)), all = o.lasting.value_or(over + 1);
    double most = 0;
    const auto send = [&](double t) -> Result<bool>
    {
        wire::UserSample s;
        const double share = std::min(1.0, t / over);
        s.position = from + share * (to - from);
        if (t < over) s.linear_velocity = (to - from) / over;
        if (auto sent = writer->send(std::move(s)); !sent) return sent.errors();
        (void)forces->take(
            [&](const plab_v2_Forces& f, const dds_sample_info_t& info)
            {
                for (const plab_v2_UserForce& u : wire::items(f.entries))
                    if (info.valid_data && hand == u.user) most = std::max(most, length(Vec3{u.force.x, u.force.y, u.force.z}));
            });
        return t < all;
    };
    if (auto moved = at_rate(c, o.rate, send); !moved) return moved.errors();
    return most;
}

Exit run_grab(Context& c, const GrabOptions& o)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    const auto from = place_of(c, o.id);
    if (!from) return c.fail(Exit::Failed, from.errors());
    Vec3 to = *from;
    for (const auto& [text, option] : {std::pair(o.to, "--to"), std::pair(o.by, "--by")})
    {
        if (text.empty()) continue;
        const auto place = parse_place(text, option);
        if (!place) return c.fail(Exit::Usage, place.errors());
        to = option == std::string("--to") ? *place : *from + *place;
    }
    const std::string grab = "grab_" + std::to_string(std::chrono::system_clock::now().time_since_epoch().count() % 1'000'000'000),
                      hand = grab + "_hand";
    const std::string xml = "<plab version='1'><component id='" + hand + "' type='State/User' position='" + text_of_place(*from) +
                            "'/><component id='" + grab + "' type='Constraint/Grab' user='" + hand + "' body='" + xml_text(o.id) +
                            "' hold='" + xml_text(o.id) + "' max_force='" + exact_number(o.force) + "'/></plab>";
    if (const Exit e = send(c, {{"add", "", "grab", xml}}); e != Exit::Done) return e;
    const auto most = move_hand(c, o, hand, *from, to);
    // The hand goes also after Ctrl-C.
    auto caller = link::Caller::make(c.session(), c.timeout());
    if (!caller) return c.fail(Exit::NoServer, caller.errors());
    const auto removed = caller->call({{{"remove", grab}, {"remove", hand}}, {}, {}}, c.timeout());
    if (!most) return c.fail(Exit::Failed, most.errors());
    if (!removed) return c.fail(Exit::NoServer, removed.errors());
    if (!removed->done()) return c.fail(Exit::Refused, removed->reasons.empty() ? "refused" : removed->reasons.front());
    if (c.settings.json)
        print(c.console, {{"released", o.id}, {"step", removed->step}, {"largest_force", *most}});
    else
        c.console.out("released " + o.id + " at step " + std::to_string(removed->step) + "; largest force " + number(*most) + " N\n");
    return c.stopped() ? Exit::Interrupted : Exit::Done;
}

void add_grab(const Command& app, Context& context)
{
    auto o = std::make_shared<GrabOptions>();
    const Command command =
        add_command(app, context,
                    {"grab", "hold a body by a soft spring with limited force, carry it somewhere, and let go",
                     "  plabctl grab red --by \"0 0 0.5\" --over 2\n  plabctl grab red --to \"1 0 1\" --force 20 --for 5\n"},
                    [o](Context& c) { return run_grab(c, *o); });
    command.add_option("id", o->id, "a body").required().type_name("ID");
    const auto to = command.add_option("--to", o->to, "carry it to this place, m").type_name("\"X Y Z\"");
    command.add_option("--by", o->by, "carry it by this displacement, m").type_name("\"X Y Z\"").excludes(to);
    command.add_option("--over", o->over, "time to get there; default: at 0.5 m/s").check(link::check_not_negative).type_name("SECONDS");
    command.add_option("--for", o->lasting, "hold it for this time in all; default: 1 s more than --over")
        .check(link::check_not_negative)
        .type_name("SECONDS");
    command.add_option("--force", o->force, "largest force, N").check(link::check_not_negative).type_name("N").show_default();
    command.add_option("--rate", o->rate, "samples per second").check(link::check_positive).type_name("HZ").show_default();
}

// ---- view -----------------------------------------------------------------------------------------------------------

struct ViewOptions
{
    std::string viewer, look_at;
    std::vector<std::string> way;
    double speed = 1, rate = 60, field_of_view = 0.7, width = 1280, height = 720;
    std::optional<double> lasting;
    bool loop = false;
};

/// A polyline that is followed at constant speed.
class Way
{
public:
    explicit Way(std::vector<Vec3> points) : points_(std::move(points))
    {
        reached_ = {0};
        for (std::size_t i = 1; i < points_.size(); ++i) reached_.push_back(reached_.back() + length(points_[i] - points_[i - 1]));
    }
    double length_of_all() const { return reached_.back(); }
    struct Place
    {
        Vec3 position, direction;  ///< direction: unit, or zero where the way has no length
    };
    Place at(double s) const
    {
        if (points_.size() == 1 || length_of_all() == 0) return {points_.front(), {}};
        s = std::clamp(s, 0.0, length_of_all());
        std::size_t i = 1;
        while (i + 1 < points_.size() && (s > reached_[i] || reached_[i] == reached_[i - 1])) ++i;
        const Vec3 along = normalized(points_[i] - points_[i - 1]);
        return {points_[i - 1] + (s - reached_[i - 1]) * along, along};
    }

private:
    std::vector<Vec3> points_;
    std::vector<double> reached_;  ///< m, along the way
};

Exit run_view(Context& c, const ViewOptions& o)
{
    std::vector<Vec3> points;
    for (const std::string& text : o.way)
    {
        const auto place = parse_place(text, "place");
        if (!place) return c.fail(Exit::Usage, place.errors());
        points.push_back(*place);
    }
    std::optional<Vec3> target;
    if (!o.look_at.empty())
    {
        const auto place = parse_place(o.look_at, "--look-at");
        if (!place) return c.fail(Exit::Usage, place.errors());
        target = *place;
    }
    if (o.loop && points.size() > 1) points.push_back(points.front());
    const Way way(points);
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto writer = link::ViewerWriter::open(c.session(), o.viewer, c.timeout(), c.stop());
    if (!writer) return c.fail(Exit::NoServer, writer.errors());
    const bool moves = way.length_of_all() > 0;
    const double all = o.lasting.value_or(moves && !o.loop ? way.length_of_all() / o.speed : 1e8);
    std::uint64_t samples = 0;
    const auto send = [&](double t) -> Result<bool>
    {
        const double s = o.loop && moves ? std::fmod(t * o.speed, way.length_of_all()) : t * o.speed;
        const Way::Place place = way.at(s);
        wire::ViewerSample sample;
        sample.position = place.position;
        if (s < way.length_of_all()) sample.velocity = o.speed * place.direction;
        const Vec3 direction = target ? normalized(*target - place.position) : place.direction;
        if (!(direction == Vec3{})) sample.direction = direction;
        if (std::fabs(sample.direction.z) > 0.999) sample.up = {1, 0, 0};
        sample.field_of_view = o.field_of_view, sample.width = o.width, sample.height = o.height;
        if (auto sent = writer->send(std::move(sample)); !sent) return sent.errors();
        ++samples;
        return t < all;
    };
    if (auto done = at_rate(c, o.rate, send); !done) return c.fail(Exit::Failed, done.errors());
    if (c.settings.json)
        print(c.console, {{"samples", samples}, {"way", way.length_of_all()}});
    else
        c.console.out("viewed from " + std::to_string(samples) + " places along " + number(way.length_of_all()) + " m\n");
    return Exit::Done;
}

void add_view(const Command& app, Context& context)
{
    auto o = std::make_shared<ViewOptions>();
    const Command command = add_command(app, context,
                                        {"view", "move a viewer of the scene: to a place, or along a way",
                                         "  plabctl view \"5 -5 2\" --look-at \"0 0 1\" --for 10\n"
                                         "  plabctl view \"0 0 2\" \"50 0 2\" \"50 50 2\" --speed 5 --loop\n"},
                                        [o](Context& c) { return run_view(c, *o); });
    command.add_option("place", o->way, "one place, or several for a way, m").required().type_name("\"X Y Z\"");
    command.add_option("--viewer", o->viewer, "component that it moves; default: the first that nobody else moves").type_name("ID");
    command.add_option("--look-at", o->look_at, "point to look at; default: ahead").type_name("\"X Y Z\"");
    command.add_option("--speed", o->speed, "along the way, m/s").check(link::check_positive).type_name("SPEED").show_default();
    command.add_flag("--loop", o->loop, "go round until --for, or Ctrl-C");
    command.add_option("--for", o->lasting, "end after this time; default: at the end of the way")
        .check(link::check_not_negative)
        .type_name("SECONDS");
    command.add_option("--fov", o->field_of_view, "vertical field of view, rad")
        .check(link::check_positive)
        .type_name("RAD")
        .show_default();
    command.add_option("--width", o->width, "of the picture, pixels").check(link::check_positive).type_name("N").show_default();
    command.add_option("--height", o->height, "of the picture, pixels").check(link::check_positive).type_name("N").show_default();
    command.add_option("--rate", o->rate, "samples per second").check(link::check_positive).type_name("HZ").show_default();
}

}  // namespace

void add_people_commands(const Command& app, Context& context)
{
    add_grab(app, context);
    add_view(app, context);
}

}  // namespace plab::cli
