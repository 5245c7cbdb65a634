print(mailbox.myHullNumber(), mailbox.hasMessages(), "[", mailbox.receive(false), "]");
mailbox.setHullNumber(4);
var heard = [];
mailbox.newMessage.connect(function(sender, text) { heard.push(sender + " " + text); });
mailbox.send(4, "to four: me");
mailbox.send("to all");
mailbox.send(5, "to nobody");
print(mailbox.receive());
print(mailbox.receive(true), mailbox.hasMessages());
while (heard.length < 2) script.wait(1);
print(heard);
print(mailbox.myHullNumber(), mailbox.isEnabled(), mailbox.isConnected(), mailbox.hasServer(), mailbox.serverIp());
mailbox.joinNetwork("", -1, 9);
print(mailbox.myHullNumber());
mailbox.clearQueue();
//> 0false[]
//> to four: me
//> to allfalse
//> [4 to four: me, 4 to all]
//> 4truefalsefalse
//> 9
