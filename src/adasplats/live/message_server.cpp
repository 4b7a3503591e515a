// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/message_server.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/view/message_values.h"

namespace adasplats {
namespace {

using FoxgloveJson = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "frames are written little-endian");

constexpr char kMessageData = 1, kTime = 2;  // operations of binary frames

template <class T>
void append_value(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string status_text(const std::string& message) {
  constexpr int kError = 2;
  return FoxgloveJson{{"op", "status"}, {"level", kError}, {"message", message}}.dump(
      -1, ' ', false, FoxgloveJson::error_handler_t::replace);
}

std::uint32_t subscription_of(const FoxgloveJson& json, const std::string& name) {
  constexpr double kMax = 4294967295.0;
  return static_cast<std::uint32_t>(message_whole_number(json, name, 0, kMax));
}

const FoxgloveJson& list_of(const FoxgloveJson& json, const std::string& name) {
  const FoxgloveJson& list = message_member(json, name);
  if (!list.is_array()) reject_message(name + ": expected a list");
  return list;
}

}  // namespace

MessageServer::MessageServer(std::string name, std::vector<Channel> channels,
                             std::size_t queue_bytes)
    : name_(std::move(name)), channels_(std::move(channels)), queue_bytes_(queue_bytes) {}

bool MessageServer::is_wanted(std::size_t channel) const {
  if (channels_.at(channel).is_latched) return true;
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(clients_, [channel](const Client& client) {
    return std::ranges::any_of(client.channel_of,
                               [channel](const auto& entry) { return entry.second == channel; });
  });
}

void MessageServer::send(Client& client, std::uint32_t subscription, std::uint64_t time_ns,
                         std::string_view bytes) {
  if (client.peer->queued_bytes() > queue_bytes_) {
    ++missed_;
    return;
  }
  constexpr std::size_t kHeadBytes = 13;
  std::string frame;
  frame.reserve(kHeadBytes + bytes.size());
  frame += kMessageData;
  append_value(frame, subscription);
  append_value(frame, time_ns);
  frame += bytes;
  client.peer->send_binary(std::make_shared<const std::string>(std::move(frame)));
}

void MessageServer::publish(std::size_t channel, std::uint64_t time_ns, std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (channels_.at(channel).is_latched) latched_[channel] = {time_ns, std::string(bytes)};
  for (Client& client : clients_)
    for (const auto& [subscription, wanted] : client.channel_of)
      if (wanted == channel) send(client, subscription, time_ns, bytes);
}

void MessageServer::publish_time(std::uint64_t time_ns) {
  std::string frame(1, kTime);
  append_value(frame, time_ns);
  const auto shared = std::make_shared<const std::string>(std::move(frame));
  const std::lock_guard lock(mutex_);
  for (Client& client : clients_)
    if (client.peer->queued_bytes() <= queue_bytes_) client.peer->send_binary(shared);
}

std::size_t MessageServer::clients() const {
  const std::lock_guard lock(mutex_);
  return clients_.size();
}

std::uint64_t MessageServer::missed() const {
  const std::lock_guard lock(mutex_);
  return missed_;
}

void MessageServer::opened(const std::shared_ptr<WebSocketPeer>& peer) {
  peer->send_text(FoxgloveJson{
      {"op", "serverInfo"},
      {"name", name_},
      {"capabilities", {"time"}},
      {"supportedEncodings",
       {"cdr"}}}.dump());
  FoxgloveJson list = FoxgloveJson::array();
  for (std::size_t i = 0; i < channels_.size(); ++i)
    list.push_back({{"id", i},
                    {"topic", channels_[i].topic},
                    {"encoding", channels_[i].message_encoding},
                    {"schemaName", channels_[i].schema_name},
                    {"schema", channels_[i].schema},
                    {"schemaEncoding", channels_[i].schema_encoding}});
  peer->send_text(FoxgloveJson{{"op", "advertise"}, {"channels", std::move(list)}}.dump());
  const std::lock_guard lock(mutex_);
  clients_.push_back({peer, {}});
}

void MessageServer::received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) {
  try {
    const FoxgloveJson json = parse_message(text);
    const std::string operation = message_text(message_member(json, "op"), "op");
    const std::lock_guard lock(mutex_);
    const auto client = std::ranges::find(clients_, peer, &Client::peer);
    if (client == clients_.end()) return;
    if (operation == "subscribe") {
      for (const FoxgloveJson& one : list_of(json, "subscriptions")) {
        const std::uint32_t id = subscription_of(message_member(one, "id"), "id");
        const std::uint32_t channel =
            subscription_of(message_member(one, "channelId"), "channelId");
        if (channel >= channels_.size()) reject_message("no channel " + std::to_string(channel));
        // Once, because each subscription gets a copy of every message.
        for (const auto& [other, subscribed] : client->channel_of)
          if (other == id || subscribed == channel)
            reject_message("subscription " + std::to_string(other) + " to channel " +
                           std::to_string(subscribed) + " exists already");
        client->channel_of[id] = channel;
        if (const auto last = latched_.find(channel); last != latched_.end())
          send(*client, id, last->second.time_ns, last->second.bytes);
      }
    } else if (operation == "unsubscribe") {
      for (const FoxgloveJson& id : list_of(json, "subscriptionIds"))
        client->channel_of.erase(subscription_of(id, "subscriptionIds"));
    } else {
      reject_message("unsupported op '" + operation.substr(0, 60) + "'");
    }
  } catch (const Error& error) {
    constexpr std::uint16_t kPolicyViolation = 1008;  // RFC 6455, 7.4.1
    if (peer->queued_bytes() > queue_bytes_)
      return peer->close(kPolicyViolation, "client too slow");
    peer->send_text(status_text(error.what()));
  }
}

void MessageServer::closed(const std::shared_ptr<WebSocketPeer>& peer) {
  const std::lock_guard lock(mutex_);
  std::erase_if(clients_, [&](const Client& client) { return client.peer == peer; });
}

}  // namespace adasplats
