namespace System.Diagnostics
// What generated F# takes of .NET and of TRIK's library, so that a compiler without them can check it.
type Process() =
    static member Start (file: string, arguments: string) = Process ()

namespace Trik
type LedColor = Red = 0 | Green = 1 | Orange = 2
type ButtonEventCode = Left = 105 | Right = 106
type Motor() =
    member _.SetPower (percent: int) = ()
    member _.Stop () = ()
type Servo() =
    member _.SetPower (degrees: int) = ()
type Sensor() =
    member _.Read () = 0
type Encoder() =
    member _.Read () = 0.0
    member _.Reset () = ()
type Vector() =
    member _.Read () : int[] = [||]
type Buttons() =
    member _.CheckPressing (code: ButtonEventCode) = true
type Led() =
    member _.SetColor (color: LedColor) = ()
    member _.PowerOff () = ()
type Ports<'a>() =
    member _.Item with get (name: string) : 'a = Unchecked.defaultof<'a>
type Model() =
    member _.Motor = Ports<Motor> ()
    member _.Servo = Ports<Servo> ()
    member _.AnalogSensor = Ports<Sensor> ()
    member _.Encoder = Ports<Encoder> ()
    member _.Gyro = Vector ()
    member _.Accel = Vector ()
    member _.LineSensor = Vector ()
    member _.Buttons = Buttons ()
    member _.Led = Led ()
