//! Helpers of the languages that drive the robot through TRIK's library for .NET.
//!
//! Owns the few calls of that library that are used, each in one helper. Knows no statements.

use super::super::code::Robot;
use super::super::print::{NONE, Row, call};

/// What the robot is told, the same in both languages.
pub(super) fn robot(robot: Robot) -> Row {
    use Robot::*;
    match robot {
        SetPower => call("setPower($1, $2)"),
        PowerOff => call("powerOff($1)"),
        Servo => call("setServo($1, $2)"),
        ResetEncoder => call("resetEncoder($1)"),
        Print => call("Console.WriteLine($1)"),
        Redraw | Finish => NONE,
    }
}

/// Helpers in Pascal; later ones may use earlier ones.
pub(super) const PASCAL: &[(&str, &str)] = &[
    ("Milliseconds", "
function Milliseconds := Environment.TickCount;"),
    ("ListOf", "
function ListOf(params values: array of real) := values.ToList;"),
    ("Item", "
// An element of a table, 0 beyond its end.
function Item(table: List<real>; index: integer): real := index < table.Count ? table[index] : 0.0;"),
    ("Put", "
// Sets an element of a table, which grows as needed.
procedure Put(table: List<real>; index: integer; value: real);
begin
  while table.Count <= index do table.Add(0);
  table[index] := value;
end;"),
    ("ToWhole", "
// The nearest whole number; halves go away from 0.
function ToWhole(number: real): integer := integer(Math.Round(number, MidpointRounding.AwayFromZero));"),
    ("ToNumber", "
// A text as a number; one that is none counts as 0.
function ToNumber(text: string): real;
begin
  if not real.TryParse(text, Result) then Result := 0;
end;"),
    ("ToTruth", "
function ToTruth(text: string) := (text <> '') and (text <> '0') and (text.ToLower <> 'false');"),
    ("ToText", "
// A number as a text, with as few digits as it needs.
function ToText(number: real) := number.ToString('R', System.Globalization.CultureInfo.InvariantCulture);"),
    ("ToPrinted", "
// A text as a display shows it: numbers with at most six digits after the point.
function ToPrinted(text: string): string;
begin
  var number: real;
  if real.TryParse(text, number) then
    Result := number.ToString('0.######', System.Globalization.CultureInfo.InvariantCulture)
  else Result := text;
end;"),
    ("Divide", "
function Divide(left, right: real): real;
begin
  if right = 0 then raise new DivideByZeroException;
  Result := left / right;
end;"),
    ("Again", "
var
  counters := new Dictionary<integer, integer>;

// Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it.
function Again(index, times: integer): boolean;
begin
  if not counters.ContainsKey(index) then counters[index] := times;
  counters[index] := counters[index] - 1;
  Result := counters[index] >= 0;
  if not Result then counters.Remove(index);
end;"),
    ("readSensor", "
function readSensor(port: string): integer := model.AnalogSensor[port].Read;"),
    ("readEncoder", "
function readEncoder(port: string): integer := Round(model.Encoder[port].Read);"),
    ("isPressed", "
function isPressed(code: integer): integer := model.Buttons.CheckPressing(ButtonEventCode(code)) ? 1 : 0;"),
    ("readGyroscope", "
function readGyroscope := model.Gyro.Read.ToList;"),
    ("readAccelerometer", "
function readAccelerometer := model.Accel.Read.ToList;"),
    ("readLine", "
function readLine := model.LineSensor.Read.ToList;"),
    ("setPower", "
procedure setPower(port: string; percent: integer);
begin
  model.Motor[port].SetPower(Max(-100, Min(100, percent)));
end;"),
    ("powerOff", "
procedure powerOff(port: string);
begin
  model.Motor[port].Stop;
end;"),
    ("setServo", "
procedure setServo(port: string; degrees: integer);
begin
  model.Servo[port].SetPower(degrees);
end;"),
    ("resetEncoder", "
procedure resetEncoder(port: string);
begin
  model.Encoder[port].Reset;
end;"),
    ("run", "
procedure run(command: string);
begin
  System.Diagnostics.Process.Start('/bin/sh', '-c \"' + command + '\"');
end;"),
    ("label_", "
procedure label_(text: string; x, y, size: integer);
begin
  Writeln(text);
end;"),
    ("wait", "
procedure wait(ms: integer);
begin
  Thread.Sleep(Max(ms, 10));
end;"),
    ("anyButton", "
function anyButton(waits: boolean): integer;
begin
  Result := -1;
  repeat
    wait(20);
    foreach var code in Arr(105, 106, 103, 108, 28, 1, 116) do
      if isPressed(code) <> 0 then Result := code;
  until (Result >= 0) or not waits;
end;"),
    ("threads StartThread JoinThread KillThread", "
var
  threads := new Dictionary<string, Thread>;

procedure StartThread(name: string; action: procedure);
begin
  threads[name] := new Thread(() -> action());
  threads[name].Start;
end;

procedure JoinThread(name: string);
begin
  if threads.ContainsKey(name) then threads[name].Join;
end;

procedure KillThread(name: string);
begin
  if threads.ContainsKey(name) then threads[name].Abort;
end;"),
];

/// Helpers in F#; later ones may use earlier ones.
pub(super) const FSHARP: &[(&str, &str)] = &[
    ("milliseconds", "
let milliseconds () = Environment.TickCount"),
    ("item", "
// An element of a table, 0 beyond its end.
let item (table: ResizeArray<float>, index: int) = if index < table.Count then table.[index] else 0.0"),
    ("put", "
// Sets an element of a table, which grows as needed.
let put (table: ResizeArray<float>, index: int, value: float) =
    while table.Count <= index do
        table.Add 0.0
    table.[index] <- value"),
    ("toWhole", "
// The nearest whole number; halves go away from 0.
let toWhole (number: float) = int (Math.Round (number, MidpointRounding.AwayFromZero))"),
    ("toNumber", "
// A text as a number; one that is none counts as 0.
let toNumber (text: string) =
    match Double.TryParse text with
    | true, number -> number
    | _ -> 0.0"),
    ("toTruth", "
let toTruth (text: string) = text <> \"\" && text <> \"0\" && text.ToLower () <> \"false\""),
    ("toText", "
// A number as a text, with as few digits as it needs.
let toText (number: float) = number.ToString (\"R\", Globalization.CultureInfo.InvariantCulture)"),
    ("toPrinted", "
// A text as a display shows it: numbers with at most six digits after the point.
let toPrinted (text: string) =
    match Double.TryParse text with
    | true, number -> number.ToString (\"0.######\", Globalization.CultureInfo.InvariantCulture)
    | _ -> text"),
    ("divide", "
let divide (left: float) (right: float) =
    if right = 0.0 then raise (DivideByZeroException ())
    left / right"),
    ("randomWhole", "
let generator = Random ()
let randomWhole (low: int, high: int) = generator.Next (low, high + 1)"),
    ("again", "
let counters = System.Collections.Generic.Dictionary<int, int> ()

// Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it.
let again (index: int, times: int) =
    let left = (if counters.ContainsKey index then counters.[index] else times) - 1
    if left < 0 then counters.Remove index |> ignore else counters.[index] <- left
    left >= 0"),
    ("readSensor", "
let readSensor (port: string) : int = model.AnalogSensor.[port].Read ()"),
    ("readEncoder", "
let readEncoder (port: string) : int = int (model.Encoder.[port].Read ())"),
    ("isPressed", "
let isPressed (code: int) = if model.Buttons.CheckPressing (enum code) then 1 else 0"),
    ("readGyroscope", "
let readGyroscope () = ResizeArray (model.Gyro.Read ())"),
    ("readAccelerometer", "
let readAccelerometer () = ResizeArray (model.Accel.Read ())"),
    ("readLine", "
let readLine () = ResizeArray (model.LineSensor.Read ())"),
    ("setPower", "
let setPower (port: string, percent: int) = model.Motor.[port].SetPower (max -100 (min 100 percent))"),
    ("powerOff", "
let powerOff (port: string) = model.Motor.[port].Stop ()"),
    ("setServo", "
let setServo (port: string, degrees: int) = model.Servo.[port].SetPower degrees"),
    ("resetEncoder", "
let resetEncoder (port: string) = model.Encoder.[port].Reset ()"),
    ("run", "
let run (command: string) = Diagnostics.Process.Start (\"/bin/sh\", \"-c \\\"\" + command + \"\\\"\") |> ignore"),
    ("label_", "
let label_ (text: string, x: int, y: int, size: int) = printfn \"%s\" text"),
    ("wait", "
let wait (ms: int) = Thread.Sleep (max ms 10)"),
    ("anyButton", "
let rec anyButton (waits: bool) : int =
    wait 20
    match List.tryFind (fun code -> isPressed code <> 0) [ 105; 106; 103; 108; 28; 1; 116 ] with
    | Some code -> code
    | None -> if waits then anyButton waits else -1"),
    ("threads startThread joinThread killThread", "
let threads = System.Collections.Generic.Dictionary<string, Thread> ()

let startThread (name: string, run: unit -> unit) =
    threads.[name] <- Thread (ThreadStart run)
    threads.[name].Start ()

let joinThread (name: string) = if threads.ContainsKey name then threads.[name].Join ()

let killThread (name: string) = if threads.ContainsKey name then threads.[name].Abort ()"),
];
