print(script.system("echo spoken; echo aloud >&2; echo kept > kept.txt", true));
print(script.readAll("kept.txt"));
//> 0
//> [kept
//> ]
