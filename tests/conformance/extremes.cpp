#include "extremes.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <sstream>

#include "model/numbers.h"
#include "model/values.h"

namespace plab::test
{
namespace
{

/// s of processor time: a step of one of these scenes takes some 20 us.
constexpr double kMostStep = 5;
/// s of processor time after which a case has been run for long enough: solvers that give up take all their internal steps each time.
constexpr double kEnough = 5;
/// s of real time after which loading, or a step, counts as endless; machines may be busy.
constexpr unsigned kEndless = 60;

/// What a child process reports to its parent.
struct Progress
{
    std::size_t at = 0;  ///< case that is being run
    char trouble[512] = {};
};

double processor_seconds()
{
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

bool is_finite(const Value& value)
{
    const auto fine = [](double x) { return std::isfinite(x); };
    if (const auto* x = std::get_if<double>(&value)) return fine(*x);
    if (const auto* v = std::get_if<Vec3>(&value)) return fine(v->x) && fine(v->y) && fine(v->z);
    if (const auto* q = std::get_if<Quat>(&value)) return fine(q->w) && fine(q->x) && fine(q->y) && fine(q->z);
    if (const auto* list = std::get_if<Reals>(&value)) return std::all_of(list->begin(), list->end(), fine);
    return true;
}

/// The first field that is not finite and is not excused.
std::string not_finite(const simulation::Simulation& s, bool reported)
{
    const world::World& world = s.world();
    for (const std::uint32_t i : world.in_id_order())
    {
        if (!world.type_of(i)) continue;
        for (const Field& field : world.type_of(i)->schema.fields())
        {
            if (field.kind == FieldKind::Scratch || field.may_be_infinite || (field.kind == FieldKind::Output && reported)) continue;
            if (const Value value = world.get(i, field.name); !is_finite(value))
                return world.id_of(i) + "." + field.name + " is " + model::format_value(value);
        }
    }
    return {};
}

/// Empty: all is well.
std::string trouble_of(const ExtremeCase& c, int steps)
{
    model::Blueprint blueprint = c.subject->blueprint;
    for (const Extreme& e : c.values) blueprint = with_field(blueprint, e.field, e.text);
    const auto refused = [](const Errors& errors)
    { return errors.empty() || errors[0].reason.empty() ? std::string("refused without a reason") : std::string(); };
    const auto scene = model::compile(blueprint, library());
    if (!scene) return refused(scene.errors());
    simulation::Simulation s(library());
    if (const auto loaded = s.load(*scene); !loaded) return refused(loaded.errors());
    bool reported = false;
    const double start = processor_seconds();
    for (int i = 0; i < steps && processor_seconds() - start < kEnough; ++i)
    {
        alarm(kEndless);
        const double before = processor_seconds();
        s.step();
        const double took = processor_seconds() - before;
        if (took > kMostStep) return "step " + std::to_string(i) + " took " + model::format_real(took) + " s";
        for (const Event& e : s.events()) reported = reported || e.severity >= Severity::Warning;
        if (const std::string what = not_finite(s, reported); !what.empty()) return what + " after step " + std::to_string(i);
    }
    return {};
}

[[noreturn]] void run_child(const std::vector<ExtremeCase>& cases, int steps, Progress& progress)
{
    for (const int crash : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGTERM}) signal(crash, SIG_DFL);
    for (; progress.at < cases.size(); ++progress.at)
    {
        alarm(kEndless);
        const std::string trouble = trouble_of(cases[progress.at], steps);
        if (trouble.empty()) continue;
        std::strncpy(progress.trouble, trouble.c_str(), sizeof progress.trouble - 1);
        break;
    }
    _exit(0);
}

bool is_whole(FieldType type) { return type == FieldType::Integer || type == FieldType::IntegerList; }

/// How many numbers a text of the field has, of which the first is put at an extreme; 0: none.
int count_of(FieldType type) { return is_whole(type) ? 1 : count_of_reals(type); }

/// What the scene gives the field, or its default; empty: neither.
std::string given_text(const Subject& subject, const Field& field)
{
    model::Blueprint copy = subject.blueprint;
    const model::ComponentNode& node = subject_node(copy);
    for (const auto* list : {&node.attributes, &node.parameters})
        for (const model::TextNode& text : *list)
            if (text.name == field.name) return text.text;
    return field.required ? std::string() : model::format_value(field.fallback);
}

void add_rule_ends(std::vector<std::string>& out, const Field& field)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const Rule& rule : field.rules)
    {
        if (rule.kind != Rule::Kind::AtLeast && rule.kind != Rule::Kind::MoreThan && rule.kind != Rule::Kind::AtMost) continue;
        if (is_whole(field.type))
        {
            const auto bound = static_cast<std::int64_t>(rule.bound);
            for (const std::int64_t n : {bound - 1, bound, bound + 1}) out.push_back(std::to_string(n));
            continue;
        }
        for (const double x : {std::nextafter(rule.bound, -kInfinity), rule.bound, std::nextafter(rule.bound, kInfinity)})
            out.push_back(model::format_real(x));
    }
}

std::vector<std::string> numbers_for(const Field& field, bool few)
{
    std::vector<std::string> out;
    if (is_whole(field.type))
        out = few ? std::vector<std::string>{"0", "1", "2147483648", "9223372036854775807"}
                  : std::vector<std::string>{"-9223372036854775808", "-1", "0", "1", "2147483647", "2147483648", "9007199254740993",
                                             "9223372036854775807"};
    else
        out = few ? std::vector<std::string>{"0", "1e-300", "1e300", "-1e30"}
                  : std::vector<std::string>{"0",     "5e-324", "1e-300", "1e-30", "1e-12",   "1e12",  "1e30",
                                             "1e150", "1e300",  "1e308",  "-1",    "-1e-300", "-1e30", "-1e308"};
    add_rule_ends(out, field);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Texts with the first number at the extreme, and with all.
std::vector<std::string> texts_for(const Subject& subject, const Field& field, bool few)
{
    std::vector<std::string> out;
    const int count = count_of(field.type);
    const std::string given = given_text(subject, field);
    for (const std::string& number : numbers_for(field, few))
    {
        std::string all = number;
        for (int i = 1; i < count; ++i) all += " " + number;
        out.push_back(all);
        std::istringstream words(given);
        std::string word, changed;
        for (int i = 0; words >> word; ++i) changed += (i == 0 ? "" : " ") + (i == 0 ? number : word);
        if (!changed.empty() && changed != all && !few) out.push_back(changed);
    }
    return out;
}

std::vector<const Field*> numeric_fields(const Subject& subject)
{
    std::vector<const Field*> out;
    for (const Field& field : schema_of(subject).fields())
        if (settable(field) && count_of(field.type) > 0) out.push_back(&field);
    return out;
}

}  // namespace

std::string ExtremeCase::name() const
{
    std::string out = subject->type;
    for (const Extreme& e : values) out += (e.field == values[0].field ? " with " : " and ") + e.field + " = " + e.text;
    return out;
}

std::vector<ExtremeCase> single_extremes(const Subject& subject)
{
    std::vector<ExtremeCase> out;
    for (const Field* field : numeric_fields(subject))
        for (const std::string& text : texts_for(subject, *field, false)) out.push_back({&subject, {{field->name, text}}});
    return out;
}

std::vector<ExtremeCase> paired_extremes(const Subject& subject)
{
    std::vector<ExtremeCase> out;
    const std::vector<const Field*> fields = numeric_fields(subject);
    for (std::size_t i = 0; i < fields.size(); ++i)
        for (std::size_t k = i + 1; k < fields.size(); ++k)
            for (const std::string& first : texts_for(subject, *fields[i], true))
                for (const std::string& second : texts_for(subject, *fields[k], true))
                    out.push_back({&subject, {{fields[i]->name, first}, {fields[k]->name, second}}});
    return out;
}

std::vector<std::string> run_extremes(const std::vector<ExtremeCase>& cases, int steps)
{
    std::vector<std::string> out;
    void* memory = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    auto& progress = *new (memory) Progress;
    while (progress.at < cases.size())
    {
        progress.trouble[0] = 0;
        std::fflush(nullptr);
        const pid_t child = fork();
        REQUIRE(child >= 0);
        if (child == 0) run_child(cases, steps, progress);
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        if (progress.at >= cases.size()) break;
        std::string why = progress.trouble;
        if (WIFSIGNALED(status))
            why = WTERMSIG(status) == SIGALRM ? "never ends" : "crashes with signal " + std::to_string(WTERMSIG(status));
        out.push_back(cases[progress.at].name() + ": " + why);
        ++progress.at;
    }
    munmap(memory, sizeof(Progress));
    return out;
}

}  // namespace plab::test
