//! Whether a request may come in: no other page in the same browser may use the robot, and no name of somebody else.
//!
//! Owns the rules, on texts alone. `Host` keeps out a name that somebody has pointed at this machine (DNS rebinding), `Origin` and
//! the cookie keep out other pages; the headers of each answer keep scripts of others out of this one.

use std::net::{IpAddr, Ipv6Addr};

/// The name of the cookie. It does not name the robot: a port is none for cookies, so the value has the port in it.
const COOKIE: &str = "trik";

/// What answers say beside their content.
pub const HEADERS: [(&str, &str); 6] = [
    (
        "content-security-policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; \
         manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cross-origin-resource-policy", "same-origin"),
    ("x-frame-options", "DENY"),
];

/// The host of `Host`, without its port; None if it is none.
fn host(value: &str) -> Option<&str> {
    let name = match value.strip_prefix('[') {
        Some(rest) => rest.split_once(']')?.0,
        None => value.split_once(':').map_or(value, |(name, _)| name),
    };
    (!name.is_empty()).then_some(name)
}

/// Whether this `Host` is one of ours: an address, this machine's own name, or a name that cannot be pointed elsewhere by others.
pub fn is_ours(value: &str, own_name: &str) -> bool {
    let Some(name) = host(value) else {
        return false;
    };
    let name = name.trim_end_matches('.').to_ascii_lowercase();
    let own = own_name.to_ascii_lowercase();
    let is_own = !own.is_empty() && (name == own || name == format!("{own}.local"));
    name == "localhost" || is_own || is_address(&name)
}

/// Whether a name is an address; one that counts in one network alone may say which interface leads there (RFC 6874).
fn is_address(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || "-._".contains(c);
    match name.split_once('%') {
        Some((address, zone)) => {
            let zone = zone.strip_prefix("25").unwrap_or(zone);
            address.parse::<Ipv6Addr>().is_ok() && !zone.is_empty() && zone.chars().all(fits)
        }
        None => name.parse::<IpAddr>().is_ok(),
    }
}

/// Whether a request from a page with this `Origin` is one of the page that this host gave. A request without one is of no page.
pub fn is_same_origin(origin: Option<&str>, host: &str) -> bool {
    origin.is_none_or(|origin| {
        let rest = origin.strip_prefix("http://");
        rest.is_some_and(|rest| rest.eq_ignore_ascii_case(host))
    })
}

/// The value of our cookie in a `Cookie` header, if it is there: the one with this port, as one browser may look at several robots.
pub fn has_cookie(header: Option<&str>, token: &str) -> bool {
    let cookies = header.unwrap_or_default().split(';');
    cookies
        .filter_map(|one| one.trim().split_once('='))
        .any(|(name, value)| name.starts_with(COOKIE) && is_equal(value, token))
}

/// Takes the same time whatever differs.
fn is_equal(one: &str, other: &str) -> bool {
    let differing = one.bytes().zip(other.bytes()).map(|(a, b)| a ^ b);
    one.len() == other.len() && differing.fold(0, |all, bits| all | bits) == 0
}

/// What sets the cookie.
pub fn cookie(token: &str, port: u16) -> String {
    format!("{COOKIE}-{port}={token}; HttpOnly; SameSite=Strict; Path=/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_is_an_address_or_a_name_of_ours() {
        for good in [
            "127.0.0.1:8000",
            "127.0.0.1",
            "[::1]:8000",
            "[fe80::1]",
            "[fe80::1%25eth0]:8000",
            "[fe80::1%wlan-0.5]",
            "localhost:8000",
            "LOCALHOST",
            "robot:8000",
            "Robot.local.:8000",
        ] {
            assert!(is_ours(good, "robot"), "{good}");
        }
        for bad in [
            "",
            ":8000",
            "[::1",
            "evil.example",
            "127.0.0.1.evil.example:8000",
            "robot.evil.example",
            "localhost.evil.example",
            "robot.local.evil",
            "[fe80::1%25]",
            "[fe80::1%]:8000",
            "[fe80::1%evil.example/x]",
            "127.0.0.1%25eth0",
            "evil.example%25eth0",
        ] {
            assert!(!is_ours(bad, "robot"), "{bad}");
        }
        assert!(!is_ours(".local", ""));
    }

    #[test]
    fn an_origin_is_the_host_or_nothing() {
        assert!(is_same_origin(None, "a:1"));
        assert!(is_same_origin(Some("http://a:1"), "A:1"));
        for bad in ["http://a:2", "https://a:1", "null", "http://a:1.evil", ""] {
            assert!(!is_same_origin(Some(bad), "a:1"), "{bad}");
        }
    }

    #[test]
    fn a_cookie_is_found_among_others_and_compared_whole() {
        assert!(has_cookie(Some("x=1; trik-8000=abc"), "abc"));
        assert!(has_cookie(Some("trik-1=zzz; trik-8000=abc"), "abc"));
        for bad in [
            None,
            Some(""),
            Some("trik-8000=ab"),
            Some("trik-8000=abcd"),
            Some("x=abc"),
            Some("abc"),
        ] {
            assert!(!has_cookie(bad, "abc"), "{bad:?}");
        }
        let set = cookie("abc", 8000);
        assert!(
            set.contains("HttpOnly") && set.contains("SameSite=Strict"),
            "{set}"
        );
    }
}
