#include <memory>
#include <set>

#include "control/live/commands.h"
#include "control/live/request.h"
#include "link/catalogue.h"

namespace plab::cli
{
namespace
{

struct NameValue
{
    std::string name, value;
};

Result<NameValue> split_at_equal(const std::string& text, const char* wanted)
{
    const std::size_t at = text.find('=');
    if (at == std::string::npos || at == 0) return reason("'" + text + "' is not " + wanted);
    return NameValue{text.substr(0, at), text.substr(at + 1)};
}

// ---- add, remove ----------------------------------------------------------------------------------------------------

void add_add(const Command& app, Context& context)
{
    struct AddOptions
    {
        std::string file;
        Timing timing;
    };
    auto o = std::make_shared<AddOptions>();
    const Command command = add_command(app, context,
                                        {"add", "add components from a blueprint",
                                         "  plabctl add ball.xml\n"
                                         "  echo '<component id=\"wind\" type=\"Field/Airflow\" between=\"red\"/>' | plabctl add -\n"},
                                        [o](Context& c)
                                        {
                                            auto text = read_text(o->file);
                                            if (!text) return c.fail(Exit::Failed, text.errors());
                                            const std::string name = o->file == "-" ? "standard input" : o->file;
                                            return send(c, {{"add", "", name, text.take()}}, o->timing);
                                        });
    command.add_option("file", o->file, "XML: <plab> or one <component>; - is standard input").required().type_name("FILE");
    add_timing(command, o->timing);
}

void add_remove(const Command& app, Context& context)
{
    struct RemoveOptions
    {
        std::vector<std::string> ids;
        Timing timing;
    };
    auto o = std::make_shared<RemoveOptions>();
    const Command command = add_command(app, context,
                                        {"remove", "remove components; several are removed together or not at all",
                                         "  plabctl remove wind\n  plabctl remove contact red\n"},
                                        [o](Context& c)
                                        {
                                            std::vector<link::Operation> operations;
                                            for (const std::string& id : o->ids) operations.push_back({"remove", id});
                                            return send(c, std::move(operations), o->timing);
                                        });
    command.add_option("id", o->ids, "components; no other component may refer to them").required().type_name("ID");
    add_timing(command, o->timing);
}

// ---- swap -----------------------------------------------------------------------------------------------------------

struct SwapOptions
{
    std::vector<std::string> ids;
    std::string to, trial, energy;
    bool or_refuse = false;
    std::vector<std::string> parameters;
    Timing timing;
};

Exit run_swap(Context& c, const SwapOptions& o)
{
    link::Operation swap{"swap", "", o.to};
    for (const std::string& text : o.parameters)
    {
        auto given = split_at_equal(text, "NAME=VALUE");
        if (!given) return c.fail(Exit::Usage, "--param: " + given.error().text());
        swap.values.push_back({given->name, given->value});
    }
    std::vector<link::Operation> operations;
    for (const std::string& id : o.ids)
    {
        operations.push_back(swap);
        operations.back().target = id;
    }
    const std::string trial = o.trial + (o.or_refuse ? (o.trial.empty() ? "or refuse" : " or refuse") : "");
    if (!trial.empty()) operations.push_back({"trial", "", trial});
    if (!o.energy.empty()) operations.push_back({"energy", "", o.energy});
    return send(c, std::move(operations), o.timing);
}

void add_swap(const Command& app, Context& context)
{
    auto o = std::make_shared<SwapOptions>();
    const Command command = add_command(app, context,
                                        {"swap", "exchange components for others of the same family, all or none",
                                         "  plabctl swap contact.response --to Response/None\n"
                                         "  plabctl swap contact.response --to Response/Impulse --param restitution=0.5\n"
                                         "  plabctl swap gears --to Constraint/AngularVelocity/Impulse --at 2400 --json\n"
                                         "  plabctl swap 'gears.*' clutch --to Constraint/AngularVelocity/Graph --trial 20 --or-refuse\n"
                                         "What can be swapped in: plabctl types --for ID\n"},
                                        [o](Context& c) { return run_swap(c, *o); });
    command.add_option("id", o->ids, "components; * matches any text, ? any character: all matching components of the new type's family")
        .required()
        .type_name("ID");
    command
        .add_option("--trial", o->trial,
                    "time budget for the trial of the first step, in ms, or none; default: ten steps' mean cost, at least 5 ms. Beyond it "
                    "the swap is "
                    "carried out untested")
        .type_name("MS");
    command.add_flag("--or-refuse", o->or_refuse, "refuse the swap if its trial takes longer");
    command.add_option("--allow-energy", o->energy, "largest factor by which the first step may multiply the energy, or any; default: 100")
        .type_name("FACTOR");
    command.add_option("--to", o->to, "the new type").required().type_name("TYPE");
    command.add_option("--param", o->parameters, "a value of the new component (may be repeated)").repeated().type_name("NAME=VALUE");
    add_timing(command, o->timing);
}

// ---- set ------------------------------------------------------------------------------------------------------------

/// Both ids and names may contain dots ("contact.response.restitution", "wind.state.count"): the longest existing id counts.
/// The server is asked only if there are several possibilities.
Result<std::set<std::string>> known_ids(Context& c)
{
    auto catalogue = link::Catalogue::open(c.session(), link::Part::Objects | link::Part::Shapes | link::Part::Interactions);
    if (!catalogue) return catalogue.errors();
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return fetched.errors();
    std::set<std::string> ids;
    for (const auto& [id, object] : catalogue->now().objects) ids.insert(id);
    for (const auto& [id, shape] : catalogue->now().shapes) ids.insert(id);
    for (const auto& [id, interaction] : catalogue->now().interactions) ids.insert(id);
    return ids;
}

std::size_t split_of(const std::string& place, const std::set<std::string>& ids)
{
    for (std::size_t dot = place.rfind('.'); dot != std::string::npos && dot > 0; dot = place.rfind('.', dot - 1))
        if (ids.count(place.substr(0, dot)) != 0) return dot;
    return place.rfind('.');
}

struct SetOptions
{
    std::vector<std::string> assignments;
    Timing timing;
};

Exit run_set(Context& c, const SetOptions& o)
{
    std::vector<NameValue> given;
    bool is_ambiguous = false;
    for (const std::string& text : o.assignments)
    {
        auto split = split_at_equal(text, "ID.NAME=VALUE");
        if (!split) return c.fail(Exit::Usage, split.errors());
        const std::size_t first = split->name.find('.'), last = split->name.rfind('.');
        if (first == std::string::npos || first == 0 || last + 1 == split->name.size())
            return c.fail(Exit::Usage, "'" + text + "' is not ID.NAME=VALUE");
        is_ambiguous |= first != last;
        given.push_back(split.take());
    }
    std::set<std::string> ids;
    if (is_ambiguous)
    {
        if (const Exit e = c.connect(); e != Exit::Done) return e;
        auto known = known_ids(c);
        if (!known) return c.fail(Exit::NoServer, known.errors());
        ids = known.take();
    }
    std::vector<link::Operation> operations;
    for (NameValue& g : given)
    {
        const std::size_t dot = split_of(g.name, ids);
        const std::string id = g.name.substr(0, dot);
        if (operations.empty() || operations.back().target != id) operations.push_back({"set", id});
        operations.back().values.push_back({g.name.substr(dot + 1), std::move(g.value)});
    }
    return send(c, std::move(operations), o.timing);
}

void add_set(const Command& app, Context& context)
{
    auto o = std::make_shared<SetOptions>();
    const Command command = add_command(app, context,
                                        {"set", "set parameters and states, all at one step boundary",
                                         "  plabctl set red.mass=0.03\n"
                                         "  plabctl set contact.response.restitution=0.5 motor.angular_velocity=20\n"
                                         "  plabctl set 'red.position=1.4 0.3 1' --at 600\n"},
                                        [o](Context& c) { return run_set(c, *o); });
    command.add_option("assignment", o->assignments, "values in SI units").required().type_name("ID.NAME=VALUE");
    add_timing(command, o->timing);
}

// ---- push -----------------------------------------------------------------------------------------------------------

void add_push(const Command& app, Context& context)
{
    struct PushOptions
    {
        std::string id, impulse;
        std::optional<std::string> point;
        Timing timing;
    };
    auto o = std::make_shared<PushOptions>();
    const Command command = add_command(app, context,
                                        {"push", "apply an impulse to an object",
                                         "  plabctl push red --impulse \"0.01 0 0\"\n"
                                         "  plabctl push red --impulse \"0 0 0.02\" --point \"1.4 0.35 1\"\n"
                                         "  plabctl push fan --impulse 0.1\n"},
                                        [o](Context& c)
                                        {
                                            link::Operation push{"push", o->id};
                                            push.values.push_back({"impulse", o->impulse});
                                            if (o->point) push.values.push_back({"point", *o->point});
                                            return send(c, {std::move(push)}, o->timing);
                                        });
    command.add_option("id", o->id, "a body or a shaft").required().type_name("ID");
    command.add_option("--impulse", o->impulse, "\"x y z\" in N s; for a shaft one number in N m s").required().type_name("IMPULSE");
    command.add_option("--point", o->point, "\"x y z\" in the world, m; default: the centre of mass").type_name("POINT");
    add_timing(command, o->timing);
}

}  // namespace

void add_scene_commands(const Command& app, Context& context)
{
    add_add(app, context);
    add_remove(app, context);
    add_swap(app, context);
    add_set(app, context);
    add_push(app, context);
}

}  // namespace plab::cli
