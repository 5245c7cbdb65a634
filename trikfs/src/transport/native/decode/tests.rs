//! Tests of decoding: every layout by hand, and bytes that are no request.

use super::*;

/// A message with the right length in its header.
fn message(opcode: u32, body: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(
        u32::try_from(abi::IN_HEADER + body.len())
            .unwrap()
            .to_ne_bytes(),
    );
    bytes.extend(opcode.to_ne_bytes());
    bytes.extend(7_u64.to_ne_bytes());
    bytes.extend(2_u64.to_ne_bytes());
    for word in [1000_u32, 100, 4242, 0] {
        bytes.extend(word.to_ne_bytes());
    }
    bytes.extend(body);
    bytes
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

fn reason(bytes: &[u8]) -> &'static str {
    decode(bytes).unwrap_err().reason
}

#[test]
fn the_header_is_read() {
    let bytes = message(op::GETATTR, &[0; 16]);
    let request = decode(&bytes).unwrap();
    let header = Header {
        opcode: op::GETATTR,
        unique: 7,
        node: 2,
        uid: 1000,
        gid: 100,
        pid: 4242,
    };
    assert_eq!(
        request,
        Request {
            header,
            body: Body::GetAttr
        }
    );
}

#[test]
fn a_read_carries_position_size_and_open_flags() {
    let mut body = Vec::new();
    body.extend(9_u64.to_ne_bytes());
    body.extend(4096_u64.to_ne_bytes());
    body.extend(words(&[64, 0, 0, 0, 0o4000, 0]));
    let bytes = message(op::READ, &body);
    let expected = Body::Read {
        fh: 9,
        offset: 4096,
        size: 64,
        flags: 0o4000,
        paged: true,
    };
    assert_eq!(decode(&bytes).unwrap().body, expected);
    let bytes = message(op::READDIR, &body);
    assert_eq!(
        decode(&bytes).unwrap().body,
        Body::ReadDir {
            offset: 4096,
            size: 64
        }
    );
}

#[test]
fn a_write_must_be_as_long_as_it_says() {
    let mut body = vec![0; 16];
    body.extend(words(&[3, 0, 0, 0, 0, 0]));
    body.extend(b"abc");
    let bytes = message(op::WRITE, &body);
    assert!(matches!(
        decode(&bytes).unwrap().body,
        Body::Write { data: b"abc", .. }
    ));
    body.push(0);
    let bytes = message(op::WRITE, &body);
    assert_eq!(reason(&bytes), "a write whose size is not that of its data");
}

#[test]
fn old_and_new_kernels_introduce_themselves() {
    let bytes = message(op::INIT, &words(&[7, 26, 131_072, 0x1f_ffff]));
    let old = KernelInit {
        major: 7,
        minor: 26,
        max_readahead: 131_072,
        flags: 0x1f_ffff,
    };
    assert_eq!(decode(&bytes).unwrap().body, Body::Init(old));

    let mut new = vec![7, 45, 131_072, 1 << 30 | 1, 0x3f];
    new.extend([0; 11]);
    let bytes = message(op::INIT, &words(&new));
    let Body::Init(new) = decode(&bytes).unwrap().body else {
        panic!()
    };
    assert_eq!(new.flags, 0x3f_4000_0001);

    let bytes = message(op::INIT, &words(&[8, 0]));
    assert!(matches!(
        decode(&bytes).unwrap().body,
        Body::Init(KernelInit { major: 8, .. })
    ));
    assert_eq!(
        reason(&message(op::INIT, &words(&[7, 36, 0, 1 << 30]))),
        "shorter than its structure"
    );
}

#[test]
fn names_must_end_and_not_be_empty() {
    let bytes = message(op::LOOKUP, b"mouse\0");
    assert_eq!(
        decode(&bytes).unwrap().body,
        Body::Lookup { name: b"mouse" }
    );
    assert_eq!(
        reason(&message(op::LOOKUP, b"mouse")),
        "a name without an end"
    );
    assert_eq!(reason(&message(op::LOOKUP, b"\0")), "an empty name");
    let bytes = message(op::GETXATTR, b"\x40\0\0\0\0\0\0\0user.a\0");
    let expected = Body::GetXattr {
        name: b"user.a",
        size: u32::from_ne_bytes([0x40, 0, 0, 0]),
    };
    assert_eq!(decode(&bytes).unwrap().body, expected);
}

#[test]
fn truncate_is_told_from_chmod_and_touch() {
    let set = |valid: u32| {
        let mut body = words(&[valid, 0]);
        body.extend([0; 80]);
        let bytes = message(op::SETATTR, &body);
        match decode(&bytes).unwrap().body {
            Body::SetAttr { size, other, .. } => (size.is_some(), other),
            other => panic!("{other:?}"),
        }
    };
    let (mtime_now, ctime) = (1 << 8, 1 << 10);
    assert_eq!(set(fattr::SIZE), (true, false));
    assert_eq!(
        set(fattr::SIZE | fattr::MTIME | mtime_now | ctime),
        (true, false)
    );
    assert_eq!(set(fattr::MODE), (false, true));
    assert_eq!(set(fattr::SIZE | fattr::UID), (true, true));
    assert_eq!(set(fattr::ATIME | fattr::MTIME | mtime_now), (false, true));
}

#[test]
fn operations_that_change_names_are_not_permitted() {
    for opcode in [
        op::MKDIR,
        op::MKNOD,
        op::UNLINK,
        op::RMDIR,
        op::RENAME,
        op::RENAME2,
        op::LINK,
        op::SYMLINK,
        op::CREATE,
    ] {
        let bytes = message(opcode, b"x\0");
        assert_eq!(
            decode(&bytes).unwrap().body,
            Body::Refused(Error::NotPermitted)
        );
    }
    for (opcode, why, errno) in [
        (op::SETXATTR, Error::Unsupported, libc::EOPNOTSUPP),
        (op::IOCTL, Error::NoControl, libc::ENOTTY),
        (46, Error::NotNeeded, libc::ENOSYS),
        (9999, Error::NotNeeded, libc::ENOSYS),
    ] {
        let bytes = message(opcode, &[]);
        assert_eq!(decode(&bytes).unwrap().body, Body::Refused(why.clone()));
        assert_eq!(why.errno(), errno);
    }
}

#[test]
fn every_cut_of_a_message_is_refused_with_its_number() {
    let whole = message(op::SETATTR, &[0; 88]);
    for length in 0..whole.len() {
        let mut cut = whole[..length].to_vec();
        let unique = decode(&cut).unwrap_err().unique;
        assert_eq!(
            unique,
            (length >= abi::IN_HEADER).then_some(7),
            "{length} bytes"
        );
        if length >= abi::IN_HEADER {
            // With an honest length only the fields that are used have to be there.
            cut[..4].copy_from_slice(&u32::try_from(length).unwrap().to_ne_bytes());
            assert_eq!(
                decode(&cut).is_ok(),
                length >= abi::IN_HEADER + 24,
                "{length} bytes"
            );
        }
    }
}
