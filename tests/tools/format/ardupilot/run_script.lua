-- SPDX-License-Identifier: Apache-2.0
-- Runs a script as ArduPilot's scripting does (libraries/AP_Scripting), with the bindings that a drive
-- needs, and prints every change of an output and every text:
--
--   lua5.3 run_script.lua SCRIPT END_MS MISSING_FUNCTION EVENT_MS=EVENT...
--
-- EVENT: arm, disarm, or pause (scripting stands still for a second). The outputs of motors are
-- channels 0 to 11. Lines: "MS CHANNEL PULSE", "MS CHANNEL released", "MS text SEVERITY WORDS".
local script, end_ms, missing = arg[1], tonumber(arg[2]), tonumber(arg[3])
local kRunMs = 3 -- of a run of the script, and its delay
local kSteps = 10000 -- SCR_VM_I_COUNT by default
local now, armed = 0, false
local outputs = {} -- channel: pulse, end of the hold

local function integer(value, least, most)
  assert(math.type(value) == "integer" and value >= least and value <= most,
         "argument out of range: " .. tostring(value))
  return value
end

-- The outputs of motors 1 to 12: SERVOn_FUNCTION 33 to 40, then 82 to 85.
local function channel_of(motor_function)
  if motor_function == missing then
    return nil
  end
  return motor_function <= 40 and motor_function - 33 or motor_function - 82 + 8
end

local arming, gcs, SRV_Channels = {}, {}, {}

function arming.is_armed(self)
  assert(self == arming)
  return armed
end

function gcs.send_text(self, severity, text)
  assert(self == gcs and type(text) == "string" and #text <= 50)
  print(now, "text", integer(severity, 0, 7), text)
end

function SRV_Channels.find_channel(self, motor_function)
  assert(self == SRV_Channels)
  return channel_of(integer(motor_function, 0, 200))
end

function SRV_Channels.set_output_pwm_chan_timeout(self, channel, pulse, timeout_ms)
  assert(self == SRV_Channels)
  integer(channel, 0, 31)
  integer(pulse, 0, 65535)
  integer(timeout_ms, 0, 65535)
  if not outputs[channel] or outputs[channel].pulse ~= pulse then
    print(now, channel, pulse)
  end
  outputs[channel] = {pulse = pulse, until_ms = now + timeout_ms}
end

local function millis()
  return setmetatable({}, {__index = {toint = function() return now end}})
end

local bindings = {arming = arming, gcs = gcs, SRV_Channels = SRV_Channels, millis = millis,
                  math = math, table = table, string = string, ipairs = ipairs, pairs = pairs,
                  assert = assert, tostring = tostring, tonumber = tonumber, type = type}

-- A run: the next function and its delay, or an error as of a script that is removed.
local function run(step)
  debug.sethook(function() error("exceeded time limit") end, "", kSteps)
  local results = table.pack(step())
  debug.sethook()
  assert(results.n == 2, "bad result count")
  assert(type(results[1]) == "function" and type(results[2]) == "number" and results[2] >= 0)
  return results[1], results[2]
end

local events = {}
for i = 4, #arg do
  local time, name = arg[i]:match("^(%d+)=(%a+)$")
  events[tonumber(time)] = name
end
local step = assert(loadfile(script, "t", bindings))
local next_ms = 0
while now <= end_ms do
  if events[now] == "pause" then
    next_ms = math.max(next_ms, now + 1000)
  elseif events[now] then
    armed = events[now] == "arm"
  end
  if now >= next_ms then
    local delay
    step, delay = run(step)
    next_ms = now + math.tointeger(delay // 1) + kRunMs
  end
  for channel = 0, 31 do
    if outputs[channel] and now >= outputs[channel].until_ms then
      print(now, channel, "released")
      outputs[channel] = nil
    end
  end
  now = now + 1
end
