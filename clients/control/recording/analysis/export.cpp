#include "control/recording/analysis/export.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "control/recording/analysis/tables.h"
#include "idl/json/json.h"
#include "idl/samples.h"
#include "link/names.h"
#include "program/text_out.h"

namespace plab::analysis
{
namespace
{

namespace fs = std::filesystem;

const std::string kVersion = "plab::v2";

/// "plab/states" as part of a file name: "states".
std::string file_stem(const std::string& topic)
{
    std::string out = topic.substr(topic.starts_with("plab/") ? 5 : 0);
    std::replace(out.begin(), out.end(), '/', '_');
    return out;
}

std::vector<std::string> topics_in(const Log& log)
{
    std::set<std::string> out;
    for (const auto& [id, channel] : log.reader().channels()) out.insert(channel.topic);
    return {out.begin(), out.end()};
}

/// Full names, each once; an error names the ones that the recording has.
Result<std::vector<std::string>> asked_for(const Log& log, const std::vector<std::string>& topics)
{
    const std::vector<std::string> known = topics_in(log);
    std::vector<std::string> out;
    for (const std::string& name : topics)
    {
        const std::string topic = full_topic(name);
        if (std::find(known.begin(), known.end(), topic) == known.end())
        {
            std::string list;
            for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
            return reason(log.path() + " has no topic '" + name + "'" + link::did_you_mean(topic, known) + "; it has " +
                          (list.empty() ? "none" : list));
        }
        if (std::find(out.begin(), out.end(), topic) == out.end()) out.push_back(topic);
    }
    return out;
}

bool is_folder(const std::string& path)
{
    std::error_code ignored;
    return !path.empty() && (path.back() == '/' || fs::is_directory(path, ignored));
}

std::string names_of_tables()
{
    std::string out;
    for (const Table& table : tables()) out += (out.empty() ? "" : ", ") + std::string(table.topic);
    return out;
}

Result<std::vector<std::string>> tables_asked_for(const Log& log, const ExportOptions& options)
{
    auto topics = asked_for(log, options.topics);
    if (!topics) return topics;
    for (const std::string& topic : *topics)
        if (find_table(topic) == nullptr) return reason(topic + " has no table; those that have one: " + names_of_tables());
    if (topics->size() > 1 && !is_folder(options.out))
        return reason("several tables need a folder: name one topic, or a folder that exists or ends with '/'");
    if (!topics->empty()) return topics;
    if (!is_folder(options.out)) return asked_for(log, {wire::topic_of<plab_v2_Frame>().name});
    for (const std::string& topic : topics_in(log))
        if (find_table(topic) != nullptr) topics->push_back(topic);
    return topics;
}

/// The tables that are being written.
class CsvFiles
{
public:
    static Result<CsvFiles> open(const std::vector<std::string>& topics, const std::string& path)
    {
        CsvFiles out;
        std::error_code failed;
        if (is_folder(path)) fs::create_directories(path, failed);
        if (failed) return reason("cannot make the folder " + path + ": " + failed.message());
        for (const std::string& topic : topics)
        {
            const std::string name = is_folder(path) ? (fs::path(path) / (file_stem(topic) + ".csv")).string() : path;
            auto file = program::TextOut::open(name);
            if (!file) return file.errors();
            const Table& table = *find_table(topic);
            file->write(head_of(table));
            out.names_.push_back(name);
            out.files_.emplace(topic, File{&table, file.take()});
        }
        return out;
    }

    /// False: writing to all of them has ended.
    bool add(const Entry& entry, const Things& things)
    {
        const auto found = files_.find(entry.channel->topic);
        if (found == files_.end()) return true;
        found->second.table->add_rows(entry, things, rows_);
        found->second.out.write(rows_.take());
        return !found->second.out.is_over();
    }
    Result<std::vector<std::string>> finish()
    {
        for (auto& [topic, file] : files_)
            if (auto done = file.out.finish(); !done) return done.errors();
        return names_;
    }

private:
    struct File
    {
        const Table* table;
        program::TextOut out;
    };
    std::map<std::string, File> files_;
    std::vector<std::string> names_;
    CsvRow rows_;
};

/// The value (idl/values/values.h) of each type of the wire.
template <class Sample>
struct ValueOf;
#define PLAB_VALUE_OF(Name)        \
    template <>                    \
    struct ValueOf<plab_v2_##Name> \
    {                              \
        using Type = wire::Name;   \
    }
PLAB_VALUE_OF(Server);
PLAB_VALUE_OF(Scene);
PLAB_VALUE_OF(SceneObject);
PLAB_VALUE_OF(Shape);
PLAB_VALUE_OF(Interaction);
PLAB_VALUE_OF(Type);
PLAB_VALUE_OF(Frame);
PLAB_VALUE_OF(Collisions);
PLAB_VALUE_OF(Events);
PLAB_VALUE_OF(Metrics);
PLAB_VALUE_OF(Request);
PLAB_VALUE_OF(Reply);
PLAB_VALUE_OF(Image);
PLAB_VALUE_OF(Journal);
PLAB_VALUE_OF(Hashes);
PLAB_VALUE_OF(Snapshot);
PLAB_VALUE_OF(Gone);
#undef PLAB_VALUE_OF

using wire::Json;

/// All members by their names in plab.idl.
template <class T>
Json plain_json(const T& value)
{
    if constexpr (Described<T>)
    {
        Json out = Json::object();
        // Appended: looking for the key, as `[]` does in an ordered object, costs more than writing it.
        auto& members = out.get_ref<Json::object_t&>();
        members.reserve(member_count<T>());
        for_each_member([&](const char* name, const auto& member) { members.Container::emplace_back(name, plain_json(member)); }, value);
        return out;
    }
    else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
        return value;
    else
    {
        Json out = Json::array();
        out.get_ref<Json::array_t&>().reserve(value.size());
        for (const auto& element : value) out.push_back(plain_json(element));
        return out;
    }
}

/// A message with all its members; null if its type is not of this version of the wire.
struct MessageJson
{
    Json operator()(std::monostate) const { return {}; }
    template <class Sample>
    Json operator()(const Sample* sample) const
    {
        return plain_json(wire::value_of<typename ValueOf<Sample>::Type>(*sample));
    }
};

std::vector<std::string> all_but_large(const Log& log)
{
    std::vector<std::string> out = topics_in(log);
    std::erase(out, wire::topic_of<plab_v2_Image>().name);
    std::erase(out, wire::topic_of<plab_v2_Snapshot>().name);
    return out;
}

}  // namespace

Result<Exported> export_csv(const Log& log, const ExportOptions& options)
{
    auto topics = tables_asked_for(log, options);
    if (!topics) return topics.errors();
    auto files = CsvFiles::open(*topics, options.out);
    if (!files) return files.errors();
    Exported out;
    Stream stream = log.stream(*topics, options.span);
    for (const Entry* entry = stream.next(); entry != nullptr; entry = stream.next())
    {
        ++out.messages[entry->channel->topic];
        if (!files->add(*entry, log.things())) break;
    }
    if (log.is_interrupted()) return reason("interrupted");
    auto finished = files->finish();
    if (!finished) return finished.errors();
    out.files = finished.take();
    out.troubles = stream.troubles();
    return out;
}

Result<Exported> export_json(const Log& log, const ExportOptions& options)
{
    auto topics = asked_for(log, options.topics);
    if (!topics) return topics.errors();
    if (is_folder(options.out)) return reason("lines of JSON are written to one file, not to the folder " + options.out);
    if (topics->empty()) *topics = all_but_large(log);
    auto file = program::TextOut::open(options.out);
    if (!file) return file.errors();
    Exported out;
    Stream stream = log.stream(*topics, options.span);
    for (const Entry* entry = topics->empty() ? nullptr : stream.next(); entry != nullptr && !file->is_over(); entry = stream.next())
    {
        const std::string& topic = entry->channel->topic;
        Json message = std::visit(MessageJson{}, entry->content);
        if (message.is_null())
        {
            out.troubles.add(topic + ": its messages are not of a type of this version of the wire (" + kVersion + ")");
            continue;
        }
        ++out.messages[topic];
        const Json line{
            {"topic", topic}, {"log_time", entry->log_time}, {"publish_time", entry->publish_time}, {"message", std::move(message)}};
        file->write(wire::line_of(line) + "\n");
    }
    out.troubles.merge(stream.troubles());
    if (log.is_interrupted()) return reason("interrupted");
    if (auto done = file->finish(); !done) return done.errors();
    out.files = {options.out};
    return out;
}

}  // namespace plab::analysis
