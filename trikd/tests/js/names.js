print(A6, T3, W4, D3, F1, M4, B4, E4, C3, S6, SS14, U7_0x20, U1_0x11, TEMP_DHT11_14, HUM_DHT22_1, video1, video2);
print(KeysEnum.Left, " ", KeysEnum.Up, " ", KeysEnum.Down, " ", KeysEnum.Enter, " ", KeysEnum.Right, " ", KeysEnum.Power, " ", KeysEnum.Esc);
print(Events.Sync, Events.Key, Events.Relative, Events.Absolute, Events.Misc);
print(MouseEventCodes.LeftBtn, " ", MouseEventCodes.Wheel, " ", PadEventCodes.BtnA, " ", PadEventCodes.BtnZ, " ", PadEventCodes.BtnStart);
print(PadEventCodes.Rx, PadEventCodes.Throttle, PadEventCodes.Break, PadEventCodes.Hat1Y, PadEventCodes.South);
var A1 = "mine";
const B1 = 5;
print(A1, B1);
//> A6T3W4D3F1M4B4E4C3S6SS14U7_0x20U1_0x11TEMP_DHT11_14HUM_DHT22_1video1video2
//> 105 103 108 28 106 116 1
//> 01234
//> 272 8 304 309 315
//> 361019304
//> mine5
