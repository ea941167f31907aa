// ROS messages as Cyclone and the types of idl/ros write and read them, for compare.mjs, which compares them with other people's code.
//
//   ros_samples types                   NAME HASH of each message: of topics, requests and responses
//   ros_samples echo                    reads lines NAME HEX, decodes the bytes and writes them again: lines HEX, or the error
//   ros_samples listen DOMAIN SECONDS   prints lines TOPIC NAME HEX of what arrives on the topics of ROS
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>
#include <sstream>

#include "idl/domain.h"
#include "idl/recording/cdr.h"
#include "idl/ros_topics.h"

namespace
{

using namespace plab;
namespace ros = wire::ros;

std::map<std::string, std::pair<const dds_topic_descriptor_t*, std::string>> types()
{
    std::map<std::string, std::pair<const dds_topic_descriptor_t*, std::string>> out;
    for (const ros::MessageTopic& topic : ros::topics()) out[topic.type->m_typename] = {topic.type, topic.type_hash};
    out[ros::kGraph.type->m_typename] = {ros::kGraph.type, ros::kGraph.type_hash};
    for (const ros::ServiceInfo& service : ros::services())
    {
        out[service.request->m_typename] = {service.request, service.request_hash};
        out[service.response->m_typename] = {service.response, service.response_hash};
    }
    return out;
}

std::string hex(recording::ByteView bytes)
{
    std::string out;
    for (const unsigned byte : bytes)
        for (const unsigned digit : {byte >> 4, byte & 15u}) out += "0123456789abcdef"[digit];
    return out;
}

std::vector<unsigned char> bytes_of(const std::string& text)
{
    std::vector<unsigned char> out;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2)
        out.push_back(static_cast<unsigned char>(std::stoi(text.substr(i, 2), nullptr, 16)));
    return out;
}

std::string echoed(const dds_topic_descriptor_t& type, const std::string& text)
{
    std::vector<std::uint64_t> memory(type.m_size / sizeof(std::uint64_t) + 1);
    recording::Decoder decoder;
    recording::Encoder encoder;
    const std::vector<unsigned char> bytes = bytes_of(text);
    const auto decoded = decoder.decode(bytes, memory.data(), type);
    if (!decoded) return "cannot be decoded: " + decoded.error().text();
    const auto encoded = encoder.encode(memory.data(), type);
    const std::string out = encoded ? hex(*encoded) : "cannot be encoded: " + encoded.error().text();
    dds_sample_free(memory.data(), &type, DDS_FREE_CONTENTS);
    return out;
}

int echo()
{
    const auto known = types();
    for (std::string line; std::getline(std::cin, line);)
    {
        std::istringstream words(line);
        std::string name, text;
        words >> name >> text;
        const auto type = known.find(name);
        std::printf("%s\n", type == known.end() ? "unknown type" : echoed(*type->second.first, text).c_str());
    }
    return 0;
}

int listen(std::uint32_t domain, double seconds)
{
    auto participant = wire::join({domain, ""});
    if (!participant) return std::fprintf(stderr, "%s\n", participant.error().text().c_str()), 1;
    std::vector<std::pair<wire::Entity, const ros::MessageTopic*>> readers;
    for (const ros::MessageTopic& topic : ros::topics())
    {
        const std::string name = ros::topic_name("", topic.name);
        const wire::Entity made(dds_create_topic(participant->get(), topic.type, name.c_str(), nullptr, nullptr));
        const wire::Qos qos = ros::qos_of({topic.profile.is_reliable, topic.profile.is_transient_local, 1000}, topic.type_hash);
        readers.emplace_back(wire::Entity(dds_create_reader(participant->get(), made.get(), qos.get(), nullptr)), &topic);
    }
    recording::Encoder encoder;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end)
    {
        for (const auto& [reader, topic] : readers)
        {
            void* sample = nullptr;
            dds_sample_info_t info{};
            while (dds_take(reader.get(), &sample, &info, 1, 1) > 0)
            {
                if (const auto bytes = encoder.encode(sample, *topic->type); bytes && info.valid_data)
                    std::printf("%s %s %s\n", topic->name, topic->type->m_typename, hex(*bytes).c_str());
                (void)dds_return_loan(reader.get(), &sample, 1);
            }
        }
        dds_sleepfor(DDS_MSECS(2));
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::string mode = argc > 1 ? argv[1] : "";
    if (mode == "echo") return echo();
    if (mode == "listen" && argc == 4) return listen(static_cast<std::uint32_t>(std::stoul(argv[2])), std::stod(argv[3]));
    if (mode != "types") return std::fprintf(stderr, "usage: ros_samples types | echo | listen DOMAIN SECONDS\n"), 2;
    for (const auto& [name, type] : types()) std::printf("%s %s\n", name.c_str(), type.second.c_str());
    return 0;
}
