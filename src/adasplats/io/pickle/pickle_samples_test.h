// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace adasplats::io_test {

// Pickles that pandas 1.5.3 wrote with Python 3.11, in base64. Four, Five and Old: the columns
// x (1.5, 2), t (0.1, 0.2) and d (0, 1), by protocols 4 and 5, and with the blocks as pandas before
// 1.3 had them (pandas.read_pickle reads all). Rows: x y z of float32 (1 2 3, 4 5 6), made of rows.
// Mixed: s ("a", "b"), w (True, False), k of int32 (-1, 2).
inline constexpr std::string_view kPandasFour =
    "gASVEQMAAAAAAACMEXBhbmRhcy5jb3JlLmZyYW1llIwJRGF0YUZyYW1llJOUKYGUfZQojARfbWdylIwecGFuZGFzLmNv"
    "cmUuaW50ZXJuYWxzLm1hbmFnZXJzlIwMQmxvY2tNYW5hZ2VylJOUjBZwYW5kYXMuX2xpYnMuaW50ZXJuYWxzlIwPX3Vu"
    "cGlja2xlX2Jsb2NrlJOUjBVudW1weS5jb3JlLm11bHRpYXJyYXmUjAxfcmVjb25zdHJ1Y3SUk5SMBW51bXB5lIwHbmRh"
    "cnJheZSTlEsAhZRDAWKUh5RSlChLAUsCSwKGlGgPjAVkdHlwZZSTlIwCZjiUiYiHlFKUKEsDjAE8lE5OTkr/////Sv//"
    "//9LAHSUYolDIAAAAAAAAPg/AAAAAAAAAECamZmZmZm5P5qZmZmZmck/lHSUYowIYnVpbHRpbnOUjAVzbGljZZSTlEsA"
    "SwJLAYeUUpRLAoeUUpRoC2gOaBFLAIWUaBOHlFKUKEsBSwFLAoaUaBiMAmk4lImIh5RSlChLA2gcTk5OSv////9K////"
    "/0sAdJRiiUMQAAAAAAAAAAABAAAAAAAAAJR0lGJoIksCSwNLAYeUUpRLAoeUUpSGlF2UKIwYcGFuZGFzLmNvcmUuaW5k"
    "ZXhlcy5iYXNllIwKX25ld19JbmRleJSTlGg3jAVJbmRleJSTlH2UKIwEZGF0YZRoDmgRSwCFlGgTh5RSlChLAUsDhZRo"
    "GIwCTziUiYiHlFKUKEsDjAF8lE5OTkr/////Sv////9LP3SUYoldlCiMAXiUjAF0lIwBZJRldJRijARuYW1llE51hpRS"
    "lGg5jBlwYW5kYXMuY29yZS5pbmRleGVzLnJhbmdllIwKUmFuZ2VJbmRleJSTlH2UKGhMTowFc3RhcnSUSwCMBHN0b3CU"
    "SwKMBHN0ZXCUSwF1hpRSlGWGlFKUjARfdHlwlIwJZGF0YWZyYW1llIwJX21ldGFkYXRhlF2UjAVhdHRyc5R9lIwGX2Zs"
    "YWdzlH2UjBdhbGxvd3NfZHVwbGljYXRlX2xhYmVsc5SIc3ViLg==";

inline constexpr std::string_view kPandasFive =
    "gAWVLAMAAAAAAACMEXBhbmRhcy5jb3JlLmZyYW1llIwJRGF0YUZyYW1llJOUKYGUfZQojARfbWdylIwecGFuZGFzLmNv"
    "cmUuaW50ZXJuYWxzLm1hbmFnZXJzlIwMQmxvY2tNYW5hZ2VylJOUjBZwYW5kYXMuX2xpYnMuaW50ZXJuYWxzlIwPX3Vu"
    "cGlja2xlX2Jsb2NrlJOUjBJudW1weS5jb3JlLm51bWVyaWOUjAtfZnJvbWJ1ZmZlcpSTlCiWIAAAAAAAAAAAAAAAAAD4"
    "PwAAAAAAAABAmpmZmZmZuT+amZmZmZnJP5SMBW51bXB5lIwFZHR5cGWUk5SMAmY4lImIh5RSlChLA4wBPJROTk5K////"
    "/0r/////SwB0lGJLAksChpSMAUOUdJRSlIwIYnVpbHRpbnOUjAVzbGljZZSTlEsASwJLAYeUUpRLAoeUUpRoC2gOKJYQ"
    "AAAAAAAAAAAAAAAAAAAAAQAAAAAAAACUaBKMAmk4lImIh5RSlChLA2gWTk5OSv////9K/////0sAdJRiSwFLAoaUaBl0"
    "lFKUaB5LAksDSwGHlFKUSwKHlFKUhpRdlCiMGHBhbmRhcy5jb3JlLmluZGV4ZXMuYmFzZZSMCl9uZXdfSW5kZXiUk5Ro"
    "MYwFSW5kZXiUk5R9lCiMBGRhdGGUjBVudW1weS5jb3JlLm11bHRpYXJyYXmUjAxfcmVjb25zdHJ1Y3SUk5RoEIwHbmRh"
    "cnJheZSTlEsAhZRDAWKUh5RSlChLAUsDhZRoEowCTziUiYiHlFKUKEsDjAF8lE5OTkr/////Sv////9LP3SUYoldlCiM"
    "AXiUjAF0lIwBZJRldJRijARuYW1llE51hpRSlGgzjBlwYW5kYXMuY29yZS5pbmRleGVzLnJhbmdllIwKUmFuZ2VJbmRl"
    "eJSTlH2UKGhMTowFc3RhcnSUSwCMBHN0b3CUSwKMBHN0ZXCUSwF1hpRSlGWGlFKUjARfdHlwlIwJZGF0YWZyYW1llIwJ"
    "X21ldGFkYXRhlF2UjAVhdHRyc5R9lIwGX2ZsYWdzlH2UjBdhbGxvd3NfZHVwbGljYXRlX2xhYmVsc5SIc3ViLg==";

inline constexpr std::string_view kPandasOld =
    "gASVeAMAAAAAAACMEXBhbmRhcy5jb3JlLmZyYW1llIwJRGF0YUZyYW1llJOUKYGUfZQojAVfZGF0YZSMHnBhbmRhcy5j"
    "b3JlLmludGVybmFscy5tYW5hZ2Vyc5SMDEJsb2NrTWFuYWdlcpSTlCmBlChdlCiMGHBhbmRhcy5jb3JlLmluZGV4ZXMu"
    "YmFzZZSMCl9uZXdfSW5kZXiUk5RoC4wFSW5kZXiUk5R9lCiMBGRhdGGUjBVudW1weS5jb3JlLm11bHRpYXJyYXmUjAxf"
    "cmVjb25zdHJ1Y3SUk5SMBW51bXB5lIwHbmRhcnJheZSTlEsAhZRDAWKUh5RSlChLAUsDhZRoFYwFZHR5cGWUk5SMAk84"
    "lImIh5RSlChLA4wBfJROTk5K/////0r/////Sz90lGKJXZQojAF4lIwBdJSMAWSUZXSUYowEbmFtZZROdYaUUpRoDYwZ"
    "cGFuZGFzLmNvcmUuaW5kZXhlcy5yYW5nZZSMClJhbmdlSW5kZXiUk5R9lChoKU6MBXN0YXJ0lEsAjARzdG9wlEsCjARz"
    "dGVwlEsBdYaUUpRlXZQoaBRoF0sAhZRoGYeUUpQoSwFLAksChpRoHowCZjiUiYiHlFKUKEsDjAE8lE5OTkr/////Sv//"
    "//9LAHSUYolDIAAAAAAAAPg/AAAAAAAAAECamZmZmZm5P5qZmZmZmck/lHSUYmgUaBdLAIWUaBmHlFKUKEsBSwFLAoaU"
    "aB6MAmk4lImIh5RSlChLA2g9Tk5OSv////9K/////0sAdJRiiUMQAAAAAAAAAAABAAAAAAAAAJR0lGJlXZQoaA1oD32U"
    "KGgRaBRoF0sAhZRoGYeUUpQoSwFLAoWUaCGJXZQoaCVoJmV0lGJoKU51hpRSlGgNaA99lChoEWgUaBdLAIWUaBmHlFKU"
    "KEsBSwGFlGghiV2UaCdhdJRiaClOdYaUUpRlfZSMBjAuMTQuMZR9lCiMBGF4ZXOUaAqMBmJsb2Nrc5RdlCh9lCiMBnZh"
    "bHVlc5RoOIwIbWdyX2xvY3OUjAhidWlsdGluc5SMBXNsaWNllJOUSwBLAksBh5RSlHV9lChoZWhDaGZoFGgXSwCFlGgZ"
    "h5RSlChLAUsBhZRoR4lDCAIAAAAAAAAAlHSUYnVldXN0lGKMBF90eXCUjAlkYXRhZnJhbWWUjAlfbWV0YWRhdGGUXZR1"
    "Yi4=";

inline constexpr std::string_view kPandasRows =
    "gASVowIAAAAAAACMEXBhbmRhcy5jb3JlLmZyYW1llIwJRGF0YUZyYW1llJOUKYGUfZQojARfbWdylIwecGFuZGFzLmNv"
    "cmUuaW50ZXJuYWxzLm1hbmFnZXJzlIwMQmxvY2tNYW5hZ2VylJOUjBZwYW5kYXMuX2xpYnMuaW50ZXJuYWxzlIwPX3Vu"
    "cGlja2xlX2Jsb2NrlJOUjBVudW1weS5jb3JlLm11bHRpYXJyYXmUjAxfcmVjb25zdHJ1Y3SUk5SMBW51bXB5lIwHbmRh"
    "cnJheZSTlEsAhZRDAWKUh5RSlChLAUsDSwKGlGgPjAVkdHlwZZSTlIwCZjSUiYiHlFKUKEsDjAE8lE5OTkr/////Sv//"
    "//9LAHSUYohDGAAAgD8AAABAAABAQAAAgEAAAKBAAADAQJR0lGKMCGJ1aWx0aW5zlIwFc2xpY2WUk5RLAEsDSwGHlFKU"
    "SwKHlFKUhZRdlCiMGHBhbmRhcy5jb3JlLmluZGV4ZXMuYmFzZZSMCl9uZXdfSW5kZXiUk5RoKYwFSW5kZXiUk5R9lCiM"
    "BGRhdGGUaA5oEUsAhZRoE4eUUpQoSwFLA4WUaBiMAk84lImIh5RSlChLA4wBfJROTk5K/////0r/////Sz90lGKJXZQo"
    "jAF4lIwBeZSMAXqUZXSUYowEbmFtZZROdYaUUpRoK4wZcGFuZGFzLmNvcmUuaW5kZXhlcy5yYW5nZZSMClJhbmdlSW5k"
    "ZXiUk5R9lChoPk6MBXN0YXJ0lEsAjARzdG9wlEsCjARzdGVwlEsBdYaUUpRlhpRSlIwEX3R5cJSMCWRhdGFmcmFtZZSM"
    "CV9tZXRhZGF0YZRdlIwFYXR0cnOUfZSMBl9mbGFnc5R9lIwXYWxsb3dzX2R1cGxpY2F0ZV9sYWJlbHOUiHN1Yi4=";

inline constexpr std::string_view kPandasMixed =
    "gASVKAMAAAAAAACMEXBhbmRhcy5jb3JlLmZyYW1llIwJRGF0YUZyYW1llJOUKYGUfZQojARfbWdylIwecGFuZGFzLmNv"
    "cmUuaW50ZXJuYWxzLm1hbmFnZXJzlIwMQmxvY2tNYW5hZ2VylJOUjBZwYW5kYXMuX2xpYnMuaW50ZXJuYWxzlIwPX3Vu"
    "cGlja2xlX2Jsb2NrlJOUjBVudW1weS5jb3JlLm11bHRpYXJyYXmUjAxfcmVjb25zdHJ1Y3SUk5SMBW51bXB5lIwHbmRh"
    "cnJheZSTlEsAhZRDAWKUh5RSlChLAUsBSwKGlGgPjAVkdHlwZZSTlIwCTziUiYiHlFKUKEsDjAF8lE5OTkr/////Sv//"
    "//9LP3SUYoldlCiMAWGUjAFilGV0lGKMCGJ1aWx0aW5zlIwFc2xpY2WUk5RLAEsBSwGHlFKUSwKHlFKUaAtoDmgRSwCF"
    "lGgTh5RSlChLAUsBSwKGlGgYjAJiMZSJiIeUUpQoSwNoHE5OTkr/////Sv////9LAHSUYolDAgEAlHSUYmgkSwFLAksB"
    "h5RSlEsCh5RSlGgLaA5oEUsAhZRoE4eUUpQoSwFLAUsChpRoGIwCaTSUiYiHlFKUKEsDjAE8lE5OTkr/////Sv////9L"
    "AHSUYolDCP////8CAAAAlHSUYmgkSwJLA0sBh5RSlEsCh5RSlIeUXZQojBhwYW5kYXMuY29yZS5pbmRleGVzLmJhc2WU"
    "jApfbmV3X0luZGV4lJOUaEiMBUluZGV4lJOUfZQojARkYXRhlGgOaBFLAIWUaBOHlFKUKEsBSwOFlGgbiV2UKIwBc5SM"
    "AXeUjAFrlGV0lGKMBG5hbWWUTnWGlFKUaEqMGXBhbmRhcy5jb3JlLmluZGV4ZXMucmFuZ2WUjApSYW5nZUluZGV4lJOU"
    "fZQoaFhOjAVzdGFydJRLAIwEc3RvcJRLAowEc3RlcJRLAXWGlFKUZYaUUpSMBF90eXCUjAlkYXRhZnJhbWWUjAlfbWV0"
    "YWRhdGGUXZSMBWF0dHJzlH2UjAZfZmxhZ3OUfZSMF2FsbG93c19kdXBsaWNhdGVfbGFiZWxzlIhzdWIu";

/// The bytes of a base64 text.
inline std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : text) {
    if (digit == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(digit));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

}  // namespace adasplats::io_test
