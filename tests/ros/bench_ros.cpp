// What plabd --ros costs: bytes and messages of each topic, and processor time with and without readers, for 1, 200 and 10,000 bodies.
//
//   bench_ros [SECONDS]
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "idl/domain.h"
#include "idl/recording/cdr.h"
#include "link/frame_reader.h"
#include "ros/node.h"
#include "support/process.h"

namespace
{

using namespace plab;
namespace msg = wire::ros;

constexpr std::uint32_t kDomain = 93;

std::string scene_of(int bodies)
{
    const std::string path = std::filesystem::temp_directory_path() / ("bench_ros_" + std::to_string(bodies) + ".xml");
    std::ofstream(path) << "<plab version=\"1\"><component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
                        << "<component id=\"gravity\" type=\"Field/Gravity\" between=\"*\" acceleration=\"0 0 -0.001\"/><repeat count=\""
                        << bodies << "\" step=\"1 0 0\"><component id=\"b\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" "
                        << "angular_velocity=\"0 0 1\"/></repeat></plab>\n";
    return path;
}

/// The process that carries the bus of this server; 0: none.
int bus_of(int server)
{
    for (const auto& entry : std::filesystem::directory_iterator("/proc"))
    {
        std::ifstream status(entry.path() / "stat");
        std::string name, state;
        int pid = 0, parent = 0;
        if (status >> pid >> name >> state >> parent && parent == server && name.starts_with("(plab-bus")) return pid;
    }
    return 0;
}

struct Reader
{
    const msg::MessageTopic* topic = nullptr;
    wire::Entity entity;
    std::uint64_t messages = 0, bytes = 0;
};

void take(Reader& reader, recording::Encoder& encoder)
{
    void* sample = nullptr;
    dds_sample_info_t info{};
    while (dds_take(reader.entity.get(), &sample, &info, 1, 1) > 0)
    {
        // All messages of a topic have about the same size here.
        if (reader.bytes == 0)
            if (const auto bytes = encoder.encode(sample, *reader.topic->type)) reader.bytes = bytes->size();
        ++reader.messages;
        (void)dds_return_loan(reader.entity.get(), &sample, 1);
    }
}

enum class Readers
{
    None,   ///< of a server with --ros
    Ros,    ///< of all its topics of ROS
    Plain,  ///< one reader of plab/updates, of a server without --ros
};
constexpr const char* kWords[] = {"--ros, nobody reads", "--ros, all topics read", "without --ros, plab/updates read"};

void measure(int bodies, double seconds, Readers who)
{
    const bool reads = who == Readers::Ros;
    test::Process server({test::program("plabd"), scene_of(bodies), who == Readers::Plain ? "--states=60" : "--ros", "--name", "bench_ros",
                          "--domain", std::to_string(kDomain), "--until", std::to_string(seconds + 8), "--rate", "real"});
    if (!server.wait_for("ready after", test::Milliseconds(20000))) return (void)std::printf("%s\n", server.errors().c_str());
    auto participant = wire::join({kDomain, ""});
    if (!participant) return;
    std::vector<Reader> readers;
    for (const msg::MessageTopic& topic : msg::topics())
    {
        if (!reads) break;
        const wire::Entity made(
            dds_create_topic(participant->get(), topic.type, msg::topic_name("", topic.name).c_str(), nullptr, nullptr));
        readers.push_back(
            {&topic,
             wire::Entity(dds_create_reader(participant->get(), made.get(), msg::qos_of(topic.profile, topic.type_hash).get(), nullptr)), 0,
             0});
    }
    link::SessionOptions session_options{"bench_ros", {kDomain, ""}};
    auto session = link::Session::join(session_options);
    std::optional<link::FrameReader> frames;
    if (who == Readers::Plain && session)
        if (auto opened = link::FrameReader::open(*session)) frames = opened.take();
    recording::Encoder encoder;
    const auto run_for = [&](double time)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(time);
        while (std::chrono::steady_clock::now() < end)
        {
            for (Reader& reader : readers) take(reader, encoder);
            if (frames) (void)frames->take([](const plab_v2_Frame&) {});
            dds_sleepfor(DDS_MSECS(2));
        }
    };
    run_for(3);
    for (Reader& reader : readers) reader.messages = 0;
    const int bus = bus_of(server.pid());
    const double cpu = test::cpu_seconds(bus), cpu_server = test::cpu_seconds(server.pid());
    run_for(seconds);
    std::printf("%6d bodies, %-32s: bus %5.1f %% of a core, plabd %5.1f %%\n", bodies, kWords[static_cast<int>(who)],
                100 * (test::cpu_seconds(bus) - cpu) / seconds, 100 * (test::cpu_seconds(server.pid()) - cpu_server) / seconds);
    for (const Reader& reader : readers)
        std::printf("    %-28s %6.1f messages/s of %8llu bytes\n", reader.topic->name, static_cast<double>(reader.messages) / seconds,
                    static_cast<unsigned long long>(reader.bytes));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv)
{
    const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
    for (const int bodies : {1, 200, 10000})
        for (const Readers who : {Readers::None, Readers::Ros, Readers::Plain}) measure(bodies, seconds, who);
    return 0;
}
